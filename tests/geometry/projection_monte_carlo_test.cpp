// Projected areas are probabilities: of N rays that are uniform in the projection, N * p meet the box, with the spread
// of a binomial distribution.
#include <optional>

#include <gtest/gtest.h>

#include "geometry/area_support.h"
#include "support/mesh_families.h"

namespace raygrain {
namespace {

using test::random_area;
using test::random_box;
using test::segment_meets;

constexpr int kBoxes = 1000;
const int kRays = test::seed_count(4) == 1 ? 5'000 : 20'000;  // under sanitizers fewer
constexpr double kFar = 1e9;                                  // stands for "no far face"

struct Rectangle {
  double min_x, max_x, min_y, max_y;
  double area() const { return (max_x - min_x) * (max_y - min_y); }
};

struct Depths {
  double near_z, far_z;
};

Depths depths(const InfluenceArea& area) {
  if (const auto* plane = std::get_if<PlaneArea>(&area.shape)) return {0, static_cast<double>(plane->depth)};
  const auto& point = std::get<PointArea>(area.shape);
  return {static_cast<double>(point.near_z), static_cast<double>(point.far_z)};
}

// How many of kRays rays, uniform on a rectangle of the projection and cut to a range of depths, meet the box.
int count_hits(const AreaGeometry& area, const Rectangle& rectangle, Depths range, const Bounds& box, Random& random) {
  int hits = 0;
  for (int i = 0; i < kRays; ++i) {
    const double x = random.uniform(rectangle.min_x, rectangle.max_x);
    const double y = random.uniform(rectangle.min_y, rectangle.max_y);
    const Frame& frame = area.frame();
    const Vec3d origin = area.is_plane() ? to_world(frame, {x, y, 0}) : frame.origin;
    const Vec3d direction = area.is_plane() ? frame.forward : to_world_direction(frame, {x, y, 1});
    hits += segment_meets(box, origin, direction, range.near_z, range.far_z);
  }
  return hits;
}

// A rectangle around the whole projection with room to spare, from the parts of the box's edges beyond the near plane.
// Nothing when the whole box is before it.
std::optional<Rectangle> rectangle_around(const AreaGeometry& area, double near_z, const Bounds& box) {
  Rectangle r{1e300, -1e300, 1e300, -1e300};
  for (int i = 0; i < 8; ++i)
    for (const int bit : {1, 2, 4}) {
      Vec3d p = to_local(area.frame(), to_double(corner(box, i)));
      const Vec3d q = to_local(area.frame(), to_double(corner(box, i ^ bit)));
      if (p.z < near_z) {
        if (q.z < near_z) continue;
        p = p + (q - p) * ((near_z - p.z) / (q.z - p.z));
      }
      const double scale = area.is_plane() ? 1 : p.z;
      r = {std::fmin(r.min_x, p.x / scale), std::fmax(r.max_x, p.x / scale), std::fmin(r.min_y, p.y / scale),
           std::fmax(r.max_y, p.y / scale)};
    }
  if (r.min_x > r.max_x) return std::nullopt;
  const double room_x = 0.1 * (r.max_x - r.min_x), room_y = 0.1 * (r.max_y - r.min_y);
  return Rectangle{r.min_x - room_x, r.max_x + room_x, r.min_y - room_y, r.max_y + room_y};
}

struct Statistics {
  int count = 0, above_three = 0, none = 0, all = 0, rare = 0;
  double squares = 0;

  // Probabilities 0 and 1 must hold for every ray. Where fewer than 20 rays are expected to hit or to miss, the normal
  // distribution is no yardstick: such boxes are bounded and not counted.
  void add(double probability, int hits) {
    const double expected = kRays * probability, variance = expected * (1 - probability);
    if (probability == 0 || probability == 1) {
      EXPECT_EQ(hits, probability == 0 ? 0 : kRays);
      ++(probability == 0 ? none : all);
    } else if (variance < 20) {
      EXPECT_LE(std::fabs(hits - expected), 25);
      ++rare;
    } else {
      const double z = (hits - expected) / std::sqrt(variance);
      EXPECT_LE(std::fabs(z), 5) << "probability " << probability << ", hits " << hits;
      above_three += std::fabs(z) > 3;
      squares += z * z;
      ++count;
    }
  }
  void check() const {
    testing::Test::RecordProperty("mean_square", std::to_string(squares / count));
    testing::Test::RecordProperty("above_three", above_three);
    EXPECT_EQ(count, kBoxes);
    EXPECT_LE(above_three, kBoxes / 100);
    EXPECT_GE(squares / count, 0.85);
    EXPECT_LE(squares / count, 1.15);
  }
};

// Asks `sample` for one random area and box after another, until kBoxes of them have counted.
template <class Sample>
Statistics measure_boxes(bool plane, Sample sample) {
  Statistics statistics;
  for (uint64_t seed = 1; statistics.count < kBoxes && seed < 20 * kBoxes; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const AreaGeometry area(random_area(random, plane));
    sample(area, random_box(area, random), random, statistics);
  }
  statistics.check();
  return statistics;
}

Rectangle window(const AreaGeometry& area) {
  const Vec2d half = area.window_half();
  return {-half.x, half.x, -half.y, half.y};
}

void check_probability(bool plane) {
  const Statistics s =
      measure_boxes(plane, [](const AreaGeometry& area, const Bounds& box, Random& random, Statistics& statistics) {
        statistics.add(area.hit_probability(box), count_hits(area, window(area), depths(area.area()), box, random));
      });
  EXPECT_GT(s.none, 100);
  EXPECT_GT(s.all, 50);
}

void check_culled_area(bool plane) {
  measure_boxes(plane, [](const AreaGeometry& area, const Bounds& box, Random& random, Statistics& statistics) {
    const Depths range{area.is_plane() ? -kFar : depths(area.area()).near_z, kFar};
    statistics.add(area.projected_area(box, Culling::kWindow) / area.window_area(),
                   count_hits(area, window(area), range, box, random));
  });
}

void check_whole_area(bool plane) {
  measure_boxes(plane, [](const AreaGeometry& area, const Bounds& box, Random& random, Statistics& statistics) {
    const Depths range{area.is_plane() ? -kFar : depths(area.area()).near_z, kFar};
    const double measured = area.projected_area(box, Culling::kNone);
    const std::optional<Rectangle> rectangle = rectangle_around(area, range.near_z, box);
    if (!rectangle || !(rectangle->area() > 0)) {
      EXPECT_EQ(measured, 0);
      return;
    }
    statistics.add(measured / rectangle->area(), count_hits(area, *rectangle, range, box, random));
  });
}

TEST(ProjectionMonteCarlo, PlaneProbabilityBetweenNearAndFarFace) {
  check_probability(true);
}
TEST(ProjectionMonteCarlo, PointProbabilityBetweenNearAndFarFace) {
  check_probability(false);
}
TEST(ProjectionMonteCarlo, PlaneAreaInTheWindow) {
  check_culled_area(true);
}
TEST(ProjectionMonteCarlo, PointAreaInTheWindow) {
  check_culled_area(false);
}
TEST(ProjectionMonteCarlo, PlaneAreaWithoutCulling) {
  check_whole_area(true);
}
TEST(ProjectionMonteCarlo, PointAreaWithoutCulling) {
  check_whole_area(false);
}

}  // namespace
}  // namespace raygrain
