#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/heuristics.h"
#include "raygrain/rays.h"

#include "geometry/area_support.h"
#include "support/isotropic_rays.h"

namespace raygrain {
namespace {

using test::point_inside;
using test::random_area;
using test::random_box;
using test::random_vector;
using test::segment_meets;

Bounds small_box(const AreaGeometry& area, Random& random) {
  const double size = test::diameter(area.region()) * std::pow(10.0, random.uniform(-1.5, -0.5));
  const Vec3d middle = point_inside(area.region(), random);
  const Vec3d half = Vec3d{random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1)} * size;
  return {to_float(middle - half), to_float(middle + half)};
}

TEST(Measures, SurfaceAreaIsAQuarterOfTheSurface) {
  const Bounds box{{0, 0, 0}, {1, 2, 3}};
  EXPECT_EQ(surface_area_measure()(box), 22 / 4.0f);
  EXPECT_EQ(surface_area_measure().total(box), 22 / 4.0f);
  EXPECT_EQ(RayMeasure()(box), 22 / 4.0f);
}

TEST(Measures, DirectionalIsTheProjectedAreaOfParallelRays) {
  for (uint64_t seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const InfluenceArea area = random_area(random, true);
    const Bounds box = random_box(AreaGeometry(area), random);
    const float projected = projected_area_measure(area, Culling::kNone)(box);
    const float weighted = directional_measure(std::get<PlaneArea>(area.shape).direction)(box);
    EXPECT_NEAR(weighted, projected, 1e-6f * projected + 1e-12f);
  }
}

TEST(Measures, DirectionalRefusesNoDirection) {
  EXPECT_THROW(directional_measure({}), Error);
  EXPECT_THROW(directional_measure({NAN, 0, 0}), Error);
}

// Cauchy: over all directions the mean projected area of a convex body is a quarter of its surface.
TEST(Measures, SurfaceAreaIsTheMeanOverAllDirections) {
  Random random(5);
  const Bounds box{{0, 0, 0}, {1, 2, 0.2f}};
  double sum = 0;
  constexpr int kDirections = 200'000;
  for (int i = 0; i < kDirections;) {
    const Vec3d direction = random_vector(random);
    if (dot(direction, direction) > 1 || dot(direction, direction) < 1e-4) continue;
    const Vec3d weights = parallel_face_weights(normalized(direction));
    sum += weights.x * 0.4 + weights.y * 0.2 + weights.z * 2;
    ++i;
  }
  EXPECT_NEAR(sum / kDirections, static_cast<double>(surface_area_measure()(box)), 0.006);
}

TEST(Measures, CulledTotalIsTheWindow) {
  for (uint64_t seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const InfluenceArea area = random_area(random, seed % 2 == 0);
    const AreaGeometry geometry(area);
    const RayMeasure culled = projected_area_measure(area), whole = projected_area_measure(area, Culling::kNone);
    const Bounds box = random_box(geometry, random);
    EXPECT_EQ(culled.total(box), static_cast<float>(geometry.window_area()));
    EXPECT_EQ(whole.total(box), whole(box));
    EXPECT_LE(culled(box), culled.total(box));
    EXPECT_LE(culled(box), whole(box) * 1.00001f + 1e-12f);
    EXPECT_EQ(culled(region_bounds(geometry.region())), culled.total(box));
  }
}

TEST(Measures, ManyBoxesAtOnceAreTheSameAsOneByOne) {
  Random random(3);
  const InfluenceArea area = random_area(random, false);
  std::vector<Bounds> boxes;
  for (int i = 0; i < 100; ++i) boxes.push_back(random_box(AreaGeometry(area), random));
  const std::vector<Ray> rays = cast_rays(AreaRays{area}, 100, 1);
  for (const RayMeasure& measure : {surface_area_measure(), directional_measure({1, 2, 3}),
                                    projected_area_measure(area), solid_angle_measure(area), sampled_measure(rays)}) {
    std::vector<float> out(boxes.size());
    measure(boxes, out);
    for (size_t i = 0; i < boxes.size(); ++i) EXPECT_EQ(out[i], measure(boxes[i]));
    const std::vector<float> first = out;
    measure(boxes, out);
    EXPECT_EQ(out, first);
  }
}

constexpr float kSphere = 4 * 3.14159265f;

TEST(Measures, HugeBoxesAreFinite) {
  const Bounds huge{{-1e38f, -1e38f, -1e38f}, {1e38f, 1e38f, 1e38f}};
  EXPECT_TRUE(std::isfinite(projected_area_measure({"z", PlaneArea{}}, Culling::kNone)(huge)));
  EXPECT_TRUE(std::isfinite(projected_area_measure({"z", PointArea{}}, Culling::kNone)(huge)));
  EXPECT_EQ(projected_area_measure({"z", PlaneArea{}})(huge), 4);
  EXPECT_EQ(solid_angle_measure({"z", PointArea{}})(huge), solid_angle_measure({"z", PointArea{}}).total(huge));
  const RayMeasure solid = solid_angle_measure({"z", PointArea{}}, Culling::kNone);
  EXPECT_NEAR(solid(huge), kSphere / 2, 1e-4f);
  EXPECT_LE(solid(huge), kSphere / 2);
  EXPECT_GE(solid(huge), solid({{-1, -1, -1}, {1, 1, 1}}));
}

TEST(SolidAngleMeasure, CubeFacesShareTheSphere) {
  const Bounds cube{{-1, -2, -3}, {3, 2, 1}};
  const std::vector<InfluenceArea> areas = point_light_areas("lamp", {1, 0, -1}, cube);
  double sum = 0;
  for (const InfluenceArea& area : areas) {
    const RayMeasure measure = solid_angle_measure(area);
    EXPECT_FLOAT_EQ(measure.total(cube), kSphere / 6);
    EXPECT_EQ(measure(cube), measure.total(cube));  // the lamp is in it
    for (int axis = 0; axis < 3; ++axis)
      for (const float side : {cube.lo[axis], cube.hi[axis]}) {
        Bounds face = cube;
        face.lo[axis] = face.hi[axis] = side;
        sum += static_cast<double>(measure(face));
      }
  }
  EXPECT_NEAR(sum, static_cast<double>(kSphere), 1e-5);
}

// Tiny boxes in the middle and in a corner, of equal projected area: 1 and 1 / (3 sqrt 3) of it.
TEST(SolidAngleMeasure, CornersCountLess) {
  const InfluenceArea area{"lamp", PointArea{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 90, 90, 0.1f, 100}};
  const RayMeasure solid = solid_angle_measure(area), projected = projected_area_measure(area);
  const auto ratio = [&](float x, float y) {
    const Bounds box{{x - 0.0005f, y - 0.0005f, 1}, {x + 0.0005f, y + 0.0005f, 1}};
    return solid(box) / projected(box);
  };
  EXPECT_NEAR(ratio(0, 0), 1, 1e-6);
  EXPECT_NEAR(ratio(0.9995f, 0.9995f), 1 / (3 * std::sqrt(3.0f)), 2e-4);
  EXPECT_NEAR(ratio(0, 0) / ratio(-0.9995f, 0.9995f), 5.196, 6e-3);
}

TEST(SolidAngleMeasure, OfAPlaneAreaIsTheProjectedArea) {
  Random random(9);
  for (int i = 0; i < 200; ++i) {
    const InfluenceArea area = random_area(random, true);
    const Bounds box = random_box(AreaGeometry(area), random);
    for (const Culling culling : {Culling::kWindow, Culling::kNone}) {
      const RayMeasure solid = solid_angle_measure(area, culling), projected = projected_area_measure(area, culling);
      EXPECT_EQ(solid(box), projected(box));
      EXPECT_EQ(solid.total(box), projected.total(box));
    }
  }
}

// Isotropic rays meet boxes as often as their solid angles say: those of all kinds, cut by the near plane and windows.
TEST(SolidAngleMeasure, AgreesWithIsotropicRays) {
  constexpr size_t kRays = 4000;
  double squares = 0;
  int counted = 0;
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    InfluenceArea area = random_area(random, false);
    auto& point = std::get<PointArea>(area.shape);
    point.fov_x = std::max(point.fov_x, 70.0f), point.fov_y = std::max(point.fov_y, 70.0f);
    const AreaGeometry geometry(area);
    const RayMeasure solid = solid_angle_measure(area), whole = solid_angle_measure(area, Culling::kNone),
                     sampled = sampled_measure(test::isotropic_rays(area, kRays, seed));
    for (int i = 0; i < 10; ++i) {
      const Bounds box = random_box(geometry, random);
      const double p = static_cast<double>(solid(box)) / static_cast<double>(solid.total(box));
      EXPECT_LE(p, 1);
      EXPECT_GE(whole(box), solid(box) * 0.999999f);
      const double variance = kRays * p * (1 - p);
      if (variance < 20) continue;
      const double z = (static_cast<double>(sampled(box)) - kRays * p) / std::sqrt(variance);
      EXPECT_LE(std::fabs(z), 5) << p;
      squares += z * z;
      ++counted;
    }
  }
  EXPECT_GT(counted, 150);
  EXPECT_NEAR(squares / counted, 1, 0.3);
}

// Rays of every kind: parallel to axes, starting inside boxes and on their faces, bounded, reversed, invalid.
std::vector<Ray> mixed_rays(const Bounds& box, Random& random) {
  std::vector<Ray> rays;
  for (int i = 0; i < 200; ++i) {
    Ray ray{to_float(random_vector(random) * 3.0), to_float(random_vector(random))};
    if (i % 4 == 1) ray.direction[static_cast<int>(random.below(3))] = random.below(2) != 0 ? 0.0f : -0.0f;
    if (i % 4 == 2) ray.direction = {0, random.below(2) != 0 ? 1.0f : -1.0f, 0};
    if (i % 3 == 1) ray.origin = corner(box, static_cast<int>(random.below(8)));
    if (i % 5 == 1) ray.tmin = static_cast<float>(random.uniform(-3, 1));
    if (i % 5 > 2) ray.tmax = static_cast<float>(random.uniform(0, 3));
    rays.push_back(ray);
  }
  rays.push_back({{0, 0, 0}, {0, 0, 0}});
  rays.push_back({{NAN, 0, 0}, {1, 0, 0}});
  rays.push_back({{0, 0, 0}, {1, kInf, 0}});
  return rays;
}

TEST(Measures, SampledCountsTheRaysThatMeetABox) {
  double counted = 0;
  for (uint64_t seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    Bounds box;
    box.extend(to_float(random_vector(random)));
    box.extend(to_float(random_vector(random)));
    const std::vector<Ray> rays = mixed_rays(box, random);
    int expected = 0;
    for (const Ray& ray : rays)
      expected += is_valid(ray) && segment_meets(box, to_double(ray.origin), to_double(ray.direction),
                                                 static_cast<double>(ray.tmin), static_cast<double>(ray.tmax));
    EXPECT_EQ(sampled_measure(rays)(box), static_cast<float>(expected));
    EXPECT_EQ(sampled_measure(rays).total(box), static_cast<float>(rays.size()));
    counted += expected;
  }
  EXPECT_GT(counted, 5000);
  EXPECT_EQ(sampled_measure({})(Bounds{{0, 0, 0}, {1, 1, 1}}), 0);
}

// Rays that the caster draws for an area meet boxes as often as the projected area says.
TEST(Measures, ProjectedAreaAgreesWithSampledRays) {
  constexpr size_t kRays = 20'000;
  double squares = 0;
  int counted = 0;
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const InfluenceArea area = random_area(random, seed % 2 == 0);
    const AreaGeometry geometry(area);
    const RayMeasure culled = projected_area_measure(area),
                     sampled = sampled_measure(cast_rays(AreaRays{area}, kRays, seed));
    for (int i = 0; i < 5; ++i) {
      const Bounds box = small_box(geometry, random);
      // Rays start on the near face; parallel projection knows no near face, so such boxes must lie beyond it.
      bool beyond = true;
      for (int k = 0; k < 8; ++k) beyond = beyond && to_local(geometry.frame(), to_double(corner(box, k))).z >= 0;
      if (!beyond) continue;
      const double p = static_cast<double>(culled(box)) / static_cast<double>(culled.total(box));
      const double variance = kRays * p * (1 - p);
      if (variance < 20) continue;
      const double z = (static_cast<double>(sampled(box)) - kRays * p) / std::sqrt(variance);
      EXPECT_LE(std::fabs(z), 5);
      squares += z * z;
      ++counted;
    }
  }
  EXPECT_GT(counted, 300);
  EXPECT_NEAR(squares / counted, 1, 0.25);
}

// Rays fall on a lid that covers half of a room: what is below the lid hardly counts, what is beside it counts in full.
TEST(VisibleMeasure, CountsWhatIsHiddenLess) {
  std::vector<Ray> rays;
  Random random(3);
  for (int i = 0; i < 4000; ++i) {
    const auto x = static_cast<float>(random.uniform(-1, 1)), y = static_cast<float>(random.uniform(-1, 1));
    rays.push_back({{x, y, 1}, {0, 0, -1}, 0, x < 0 ? 0.1f : 2.0f});
  }
  const RayMeasure base = directional_measure({0, 0, 1}), visible = visible_measure(base, rays);
  const Bounds hidden{{-0.9f, -0.5f, -0.9f}, {-0.4f, 0.5f, -0.4f}}, open{{0.4f, -0.5f, -0.9f}, {0.9f, 0.5f, -0.4f}};
  const Bounds above{{-0.9f, -0.5f, 0.94f}, {-0.4f, 0.5f, 1}};
  EXPECT_EQ(visible(hidden), base(hidden) / 16);  // the least share
  EXPECT_NEAR(visible(open), base(open), 0.02f * base(open));
  EXPECT_NEAR(visible(above), base(above), 0.05f * base(above));
  const RayMeasure unknown = visible_measure(base, {});  // nothing is known: the base alone
  EXPECT_EQ(unknown(hidden), base(hidden));
  for (const Bounds& far : {Bounds{{50, 50, 50}, {51, 51, 51}}, Bounds{{-50, -50, -50}, {50, 50, 50}}})
    EXPECT_TRUE(visible(far) >= 0 && visible(far) <= base(far));
}

// Ends of rays beyond the largest float: the box of what is known has no end, and every answer must be a share.
TEST(VisibleMeasure, TakesRaysThatEndBeyondFloats) {
  const RayMeasure base = directional_measure({0, 0, 1});
  const Bounds box{{0, 0, 0}, {1, 1, 1}};
  for (const float end : {1e30f, 3e38f})
    for (const Vec3 direction : {Vec3{1e30f, 1, 0}, Vec3{-1e30f, 1e30f, -1}, Vec3{3e38f, -3e38f, 3e38f}}) {
      const std::vector<Ray> rays{{{0, 0, 0}, direction, 0, end}, {{0, 0, 5}, {0, 0, -1}, 0, 4}};
      const float value = visible_measure(base, rays)(box);
      EXPECT_TRUE(value >= 0 && value <= base(box)) << value;
    }
}

}  // namespace
}  // namespace raygrain
