#include <gtest/gtest.h>

#include "raygrain/region.h"
#include "raygrain/triangle.h"

#include "geometry/region_support.h"

namespace raygrain {
namespace {

using test::diameter;
using test::point_inside;
using test::random_region;
using test::random_vector;

TEST(RegionExit, EndsOnTheBoundary) {
  for (uint64_t seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const ConvexRegion region = random_region(seed);
    Random random(seed);
    Ray ray{to_float(point_inside(region, random)),
            to_float(random_vector(random) * std::pow(10.0, random.uniform(-10, 10)))};
    const float exit = exit_distance(region, ray);
    ASSERT_GT(exit, 0);
    const Vec3d end = to_double(ray.origin) + to_double(ray.direction) * static_cast<double>(exit);
    double highest = -1e300;
    for (const Plane& plane : region.planes) highest = std::fmax(highest, dot(plane.normal, end) - plane.offset);
    EXPECT_LE(highest, 1.01 * region.slack);
    EXPECT_GE(highest, 0.5 * region.slack);  // rounded down, but not by much
    const RayInterval interval = inside_interval(region, ray);
    EXPECT_EQ(interval.exit, exit);
    EXPECT_LE(interval.enter, 0);
  }
}

TEST(RegionExit, NothingIsBeforeItForOriginsOutsideAndInvalidRays) {
  const ConvexRegion region = box_region({{0, 0, 0}, {1, 1, 1}});
  EXPECT_EQ(exit_distance(region, {{2, 0.5f, 0.5f}, {-1, 0, 0}}), -kInf);
  EXPECT_EQ(exit_distance(region, {{0.5f, 0.5f, 0.5f}, {0, 0, 0}}), -kInf);
  EXPECT_EQ(exit_distance(region, {{0.5f, NAN, 0.5f}, {1, 0, 0}}), -kInf);
  EXPECT_EQ(exit_distance(region, {{0.5f, 0.5f, 0.5f}, {kInf, 0, 0}}), -kInf);
  EXPECT_NEAR(exit_distance(region, {{0.5f, 0.5f, 0.5f}, {1, 0, 0}}), 0.5, 1e-5);
  EXPECT_NEAR(exit_distance(region, {{1, 0.5f, 0.5f}, {1, 0, 0}}), 0, 1e-5);
  EXPECT_GE(exit_distance(region, {{1, 0.5f, 0.5f}, {1, 0, 0}}), 0);  // the boundary is inside
}

TEST(RegionExit, IntervalOfRaysThatPassThrough) {
  const ConvexRegion region = box_region({{1, 0, 0}, {2, 1, 1}});
  const RayInterval through = inside_interval(region, {{0, 0.5f, 0.5f}, {1, 0, 0}});
  EXPECT_NEAR(through.enter, 1, 1e-4);
  EXPECT_NEAR(through.exit, 2, 1e-4);
  const RayInterval past = inside_interval(region, {{0, 5, 0.5f}, {1, 0, 0}});
  EXPECT_GT(past.enter, past.exit);
  const RayInterval behind = inside_interval(region, {{3, 0.5f, 0.5f}, {1, 0, 0}});
  EXPECT_NEAR(behind.exit, -1, 1e-4);
}

TEST(RegionExit, RoundingOfDenormalParametersIsNotTrusted) {
  // One step of a denormal t moves this ray by 2^-21, more than the tiny region's slack.
  const ConvexRegion region = box_region({{0, 0, 0}, {1e-10f, 1e-10f, 1e-10f}});
  EXPECT_EQ(exit_distance(region, {{0, 0, 0}, {3e38f, 0, 0}}), -kInf);
  EXPECT_GT(exit_distance(region, {{0, 0, 0}, {1, 0, 0}}), 0);
}

// The exit rule: whatever is met at or before the exit belongs to a triangle that overlaps. Triangles are placed about
// the exit point, so that many hits fall just before and just after it.
void expect_exit_rule(uint64_t seed, double scale, int counts[2]) {
  SCOPED_TRACE(testing::Message() << "seed " << seed << " scale " << scale);
  const ConvexRegion region = random_region(seed, scale);
  Random random(seed);
  for (int i = 0; i < 20; ++i) {
    const bool from_boundary = random.below(2) != 0;
    const Vec3d start =
        from_boundary ? region.corners[0] * 0.4 + region.corners[1] * 0.6 : point_inside(region, random);
    const Ray ray{to_float(start), to_float(random_vector(random) * std::pow(10.0, random.uniform(-5, 5)))};
    const float exit = exit_distance(region, ray);
    ASSERT_GE(exit, 0);
    const double size = diameter(region) * std::pow(10.0, random.uniform(-5, 1));
    const double beyond = region.slack * random.uniform(-2, 2) / length(to_double(ray.direction));
    const Vec3d at = to_double(ray.origin) + to_double(ray.direction) * (static_cast<double>(exit) + beyond);
    const Vec3d u = random_vector(random) * size, v = random_vector(random) * size;
    const Vec3 a = to_float(at + u), b = to_float(at + v), c = to_float(at - u - v);
    Hit hit;
    if (!intersect_triangle(ray, a, b, c, hit)) continue;
    ++counts[hit.t <= exit];
    if (hit.t <= exit) {
      EXPECT_TRUE(overlaps(region, a, b, c)) << "t " << hit.t << " exit " << exit;
    }
  }
}

TEST(RegionExit, WhateverIsMetBeforeTheExitOverlaps) {
  int counts[2] = {0, 0};
  for (uint64_t seed = 1; seed <= 2000; ++seed)
    for (const double scale : {1.0, 1e-20, 1e20}) expect_exit_rule(seed, scale, counts);
  EXPECT_GT(counts[0], 5000);
  EXPECT_GT(counts[1], 5000);
}

}  // namespace
}  // namespace raygrain
