// What rays see: counts of a grid against counts ray by ray, and the measure made of them.
#include <gtest/gtest.h>

#include "raygrain/heuristics.h"
#include "raygrain/rays.h"

#include "base/random.h"
#include "heuristic/entry_grid.h"
#include "support/mesh_families.h"

namespace raygrain {
namespace {

constexpr size_t kCells = 48;

/// Rays of any direction out of a box of its own for each seed; half of them end.
std::vector<Ray> some_rays(Random& random) {
  std::vector<Ray> rays;
  for (int i = 0; i < 300; ++i) {
    const auto draw = [&](double lo, double hi) { return static_cast<float>(random.uniform(lo, hi)); };
    Ray ray{{draw(0, 8), draw(-2, 1), draw(5, 6)}, {draw(-1, 1), draw(-1, 1), draw(-1, 1)}};
    if (random.below(4) == 0) ray.tmin = draw(0, 1);
    if (random.below(2) == 0) ray.tmax = ray.tmin + draw(0, 3);
    rays.push_back(ray);
  }
  return rays;
}

/// Does the ray, from tmin to `last`, meet the box?
bool meets(const Ray& ray, const Bounds& box, double last) {
  double enter = static_cast<double>(ray.tmin), leave = last;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = ray.origin[axis], d = ray.direction[axis];
    const double first = ((d < 0 ? box.hi[axis] : box.lo[axis]) - o) / d;
    enter = std::max(enter, first);
    leave = std::min(leave, ((d < 0 ? box.lo[axis] : box.hi[axis]) - o) / d);
  }
  return enter <= leave;
}

/// Whole cells, and a box a little within them.
Bounds random_cells(Random& random, const Bounds& grid, Bounds& within) {
  Bounds cells;
  for (int axis = 0; axis < 3; ++axis) {
    const double lo = grid.lo[axis], cell = (static_cast<double>(grid.hi[axis]) - lo) / kCells;
    const auto first = static_cast<double>(random.below(kCells));
    const double count = 1 + static_cast<double>(random.below(kCells - static_cast<uint64_t>(first)));
    cells.lo[axis] = static_cast<float>(lo + cell * first);
    cells.hi[axis] = static_cast<float>(lo + cell * (first + count));
    within.lo[axis] = static_cast<float>(lo + cell * (first + 0.1));
    within.hi[axis] = static_cast<float>(lo + cell * (first + count - 0.1));
  }
  return cells;
}

TEST(EntryGrid, CountsTheRaysThatEnterABox) {
  uint32_t most = 0, ended = 0;
  for (uint64_t seed = 0; seed < test::seed_count(20); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const std::vector<Ray> rays = some_rays(random);
    const EntryGrid counted(rays);
    for (int i = 0; i < 50; ++i) {
      Bounds within;
      const Bounds cells = random_cells(random, counted.box(), within);
      uint32_t all = 0, alive = 0;
      for (const Ray& ray : rays) {
        all += meets(ray, cells, std::numeric_limits<double>::infinity());
        alive += meets(ray, cells, static_cast<double>(ray.tmax));
      }
      const EntryGrid::Counts counts = counted.entering(within);
      ASSERT_EQ(counts.all, all);
      ASSERT_EQ(counts.alive, alive);
      most = std::max(most, all);
      ended += all - alive;
    }
  }
  EXPECT_GT(most, 250u);
  EXPECT_GT(ended, 1000u);
}

/// The floor of a house under a roof that covers half of it, seen from above along an axis: all rays start in one
/// plane.
TEST(VisibleMeasure, KnowsWhatIsHiddenFromAFlatWindow) {
  const InfluenceArea area{"sun", PlaneArea{{0, 5, 0}, {0, -1, 0}, {0, 0, 1}, 2, 2, 20}};
  std::vector<Ray> rays = cast_rays(AreaRays{area}, 4096, 1);
  const RayMeasure base = projected_area_measure(area);
  const Bounds hidden{{-1.5f, -1, -1}, {-0.5f, 0, 1}}, open{{0.5f, -1, -1}, {1.5f, 0, 1}};
  const RayMeasure endless = visible_measure(base, rays);
  EXPECT_EQ(endless(hidden), base(hidden));  // nothing ends, so nothing is hidden
  EXPECT_EQ(endless(open), base(open));
  for (Ray& ray : rays) ray.tmax = ray.origin.x < 0 ? 3.0f : 8.0f;
  const RayMeasure visible = visible_measure(base, rays);
  EXPECT_EQ(visible(hidden), base(hidden) / 16);  // the least share
  EXPECT_EQ(visible(open), base(open));
  EXPECT_EQ(visible.total({}), base.total({}));
}

/// A roof in the very plane where all rays start: what is below it is hidden, though the grid has no depth.
TEST(VisibleMeasure, KnowsThatAFlatRoofHides) {
  const InfluenceArea area{"sun", PlaneArea{{0, 5, 0}, {0, -1, 0}, {0, 0, 1}, 2, 2, 20}};
  std::vector<Ray> rays = cast_rays(AreaRays{area}, 4096, 1);
  for (Ray& ray : rays) ray.tmax = 0;
  const RayMeasure base = projected_area_measure(area), visible = visible_measure(base, rays);
  const Bounds hidden{{-1, 3, -1}, {1, 4, 1}}, roof{{-1, 5, -1}, {1, 5, 1}}, house{{-1, 3, -1}, {1, 5, 1}};
  EXPECT_EQ(visible(hidden), base(hidden) / 16);
  EXPECT_EQ(visible(roof), base(roof));
  EXPECT_EQ(visible(house), base(house));
}

}  // namespace
}  // namespace raygrain
