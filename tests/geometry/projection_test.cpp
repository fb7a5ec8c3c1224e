#include <gtest/gtest.h>

#include "raygrain/area.h"

#include "geometry/area_support.h"

namespace raygrain {
namespace {

using test::diameter;
using test::random_area;
using test::random_box;
using test::random_vector;

// Figure 11 of the paper, the hull table with the shoelace formula, and three face weights are the same number.
void expect_three_ways_agree(const Frame& frame, const Bounds& box) {
  PlaneArea plane;
  plane.direction = to_float(frame.forward * 3.0);
  plane.up = to_float(frame.up);
  const AreaGeometry area({"area", plane});
  const Vec3d size = to_double(box.hi) - to_double(box.lo);
  const Vec3d weights = parallel_face_weights(area.frame().forward);
  const double by_weights = weights.x * size.y * size.z + weights.y * size.z * size.x + weights.z * size.x * size.y;
  const double tolerance = 1e-13 * dot(size, size);
  EXPECT_NEAR(three_parallelogram_area(area.frame(), box), by_weights, tolerance);
  EXPECT_NEAR(polygon_area(area.projected_hull(box, Culling::kNone)), by_weights, tolerance);
  EXPECT_NEAR(area.projected_area(box, Culling::kNone), by_weights, tolerance);
}

TEST(Projection, ThreeParallelogramsHullAndFaceWeightsAgree) {
  const Bounds box{{-1, 2, 0.5f}, {1, 3, 4}};
  for (int code = 0; code < 27; ++code) {  // all sign combinations, axes included
    const Vec3d direction{static_cast<double>(code % 3 - 1), static_cast<double>(code / 3 % 3 - 1),
                          static_cast<double>(code / 9 - 1)};
    if (direction == Vec3d{}) continue;
    SCOPED_TRACE(testing::Message() << "code " << code);
    expect_three_ways_agree(make_frame({}, direction, {0, 1, 0}), box);
    expect_three_ways_agree(make_frame({}, direction, {0.3, 1, 0.2}), box);
  }
  for (uint64_t seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    Bounds random_bounds;
    random_bounds.extend(to_float(random_vector(random)));
    random_bounds.extend(to_float(random_vector(random)));
    expect_three_ways_agree(make_frame({}, random_vector(random), random_vector(random)), random_bounds);
  }
}

TEST(Projection, AreaIsTheAreaOfTheHull) {
  for (uint64_t seed = 1; seed <= 4000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const AreaGeometry area(random_area(random, seed % 2 == 0));
    const Bounds box = random_box(area, random);
    for (const Culling culling : {Culling::kNone, Culling::kWindow}) {
      const double hull = polygon_area(area.projected_hull(box, culling));
      EXPECT_NEAR(area.projected_area(box, culling), hull, 1e-11 * hull + 1e-13);
    }
    EXPECT_LE(area.projected_area(box, Culling::kWindow), area.window_area());
    EXPECT_LE(area.projected_area(box, Culling::kWindow), area.projected_area(box, Culling::kNone) * (1 + 1e-12));
    EXPECT_LE(area.hit_probability(box), 1);
    EXPECT_LE(area.hit_probability(box) * area.window_area(),
              area.projected_area(box, Culling::kWindow) * (1 + 1e-12) + 1e-13);
  }
}

TEST(Projection, LargerBoxesAreHitMore) {
  for (uint64_t seed = 1; seed <= 4000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const AreaGeometry area(random_area(random, seed % 2 == 0));
    const Bounds small = random_box(area, random), large = united(small, random_box(area, random));
    for (const Culling culling : {Culling::kNone, Culling::kWindow})
      EXPECT_LE(area.projected_area(small, culling), area.projected_area(large, culling) * (1 + 1e-11) + 1e-13);
    EXPECT_LE(area.hit_probability(small), area.hit_probability(large) * (1 + 1e-11) + 1e-13);
  }
}

TEST(Projection, ProbabilitiesZeroAndOneAreExact) {
  for (uint64_t seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const AreaGeometry area(random_area(random, seed % 2 == 0));
    const Bounds around = region_bounds(area.region());
    EXPECT_EQ(area.hit_probability(around), 1);
    EXPECT_EQ(area.projected_area(around, Culling::kWindow), area.window_area());
    // Boxes beyond one of the region's planes.
    for (const Plane& plane : area.region().planes) {
      const Vec3d middle = plane.normal * (plane.offset + 2 * diameter(area.region()));
      const Vec3d half = Vec3d{1, 1, 1} * diameter(area.region());
      const Bounds beyond{to_float(middle - half), to_float(middle + half)};
      if (!overlaps(area.region(), beyond)) {
        EXPECT_EQ(area.hit_probability(beyond), 0);
      }
    }
    EXPECT_EQ(area.hit_probability(Bounds{}), 0);
    EXPECT_EQ(area.projected_area(Bounds{}, Culling::kNone), 0);
    EXPECT_EQ(area.projected_hull(Bounds{}, Culling::kNone).count, 0u);
  }
}

TEST(Projection, NoOverlapWithTheRegionMeansNoHit) {
  int outside = 0;
  for (uint64_t seed = 1; seed <= 20'000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const AreaGeometry area(random_area(random, seed % 2 == 0));
    const Bounds box = random_box(area, random);
    if (overlaps(area.region(), box)) continue;
    EXPECT_EQ(area.hit_probability(box), 0);
    ++outside;
  }
  EXPECT_GT(outside, 1000);
}

AreaGeometry unit_frustum() {  // 90 degrees along +z from the origin, near 1, far 10
  PointArea point;
  point.near_z = 1;
  point.far_z = 10;
  return AreaGeometry({"frustum", point});
}

TEST(Projection, BoxesAboutTheEyePlane) {
  const AreaGeometry area = unit_frustum();
  EXPECT_NEAR(area.window_area(), 4, 1e-14);
  // The eye is inside: every ray meets the box.
  EXPECT_EQ(area.hit_probability({{-5, -5, -5}, {5, 5, 5}}), 1);
  // The eye is inside, but the box ends before the near plane: rays start behind it.
  EXPECT_EQ(area.hit_probability({{-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}}), 0);
  EXPECT_EQ(area.projected_area({{-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}}, Culling::kNone), 0);
  // Behind the eye.
  EXPECT_EQ(area.hit_probability({{-1, -1, -3}, {1, 1, -2}}), 0);
  // A floor slab across the eye plane, from behind the eye to z = 10 at y = -1: covers y / z from -1 to -0.1.
  EXPECT_NEAR(area.hit_probability({{-100, -1, -10}, {100, -1, 10}}), 0.45, 1e-14);
  // Beyond the far plane: seen in the projection, never met before the far plane.
  const Bounds beyond{{-20, -20, 20}, {20, 20, 21}};
  EXPECT_EQ(area.hit_probability(beyond), 0);
  EXPECT_NEAR(area.projected_area(beyond, Culling::kNone), 4, 1e-14);
  // On the near plane, and on the far one.
  EXPECT_NEAR(area.hit_probability({{0, 0, 0}, {0.5f, 0.5f, 1}}), 0.0625, 1e-14);
  EXPECT_NEAR(area.hit_probability({{0, 0, 10}, {5, 5, 20}}), 0.0625, 1e-14);
  // Across the far plane, beside the window there but inside it farther away.
  EXPECT_EQ(area.hit_probability({{12, -1, 5}, {14, 1, 100}}), 0);
  EXPECT_GT(area.projected_area({{12, -1, 5}, {14, 1, 100}}, Culling::kWindow), 0);
}

TEST(Projection, BoxesSeenEdgeOnHaveNoArea) {
  for (uint64_t seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    InfluenceArea influence = random_area(random, false);
    const Vec3 eye = std::get<PointArea>(influence.shape).eye;
    const AreaGeometry point(influence);
    const Bounds box = random_box(point, random);
    const int axis = static_cast<int>(random.below(3)), other = (axis + 1) % 3;
    Bounds wall = box, edge = box;
    wall.lo[axis] = wall.hi[axis] = eye[axis];
    edge.hi[axis] = edge.lo[axis];
    edge.hi[other] = edge.lo[other];
    for (const Bounds& flat : {wall, edge}) {
      EXPECT_EQ(point.projected_area(flat, Culling::kNone), 0);
      EXPECT_EQ(point.projected_area(flat, Culling::kWindow), 0);
      EXPECT_EQ(point.hit_probability(flat), 0);
    }
    PlaneArea plane = test::random_plane_area(random);
    plane.direction = {};
    plane.direction[other] = 1;
    wall.lo[axis] = wall.hi[axis] = plane.center[axis];
    EXPECT_EQ(AreaGeometry({"plane", plane}).hit_probability(wall), 0);
    EXPECT_EQ(AreaGeometry({"plane", plane}).hit_probability(edge), 0);
  }
}

TEST(Projection, PlaneAreaCountsOnlyItsDepth) {
  PlaneArea plane;
  plane.center = {0, 10, 0};
  plane.direction = {0, -1, 0};
  plane.half_width = 2;
  plane.half_height = 2;
  plane.depth = 5;
  const AreaGeometry area({"sun", plane});
  EXPECT_EQ(area.hit_probability({{-1, 6, -1}, {1, 7, 1}}), 0.25);
  EXPECT_EQ(area.hit_probability({{-1, 11, -1}, {1, 12, 1}}), 0);    // behind the rays
  EXPECT_EQ(area.hit_probability({{-1, 0, -1}, {1, 4.5f, 1}}), 0);   // beyond their end
  EXPECT_EQ(area.hit_probability({{-1, 0, -1}, {1, 20, 1}}), 0.25);  // across both
  EXPECT_EQ(area.projected_area({{-1, 11, -1}, {1, 12, 1}}, Culling::kWindow), 4);
  EXPECT_EQ(area.hit_probability({{2, 6, -1}, {3, 7, 1}}), 0);  // touches the window
  EXPECT_EQ(area.hit_probability({{1, 6, -9}, {9, 7, 9}}), 0.25);
}

}  // namespace
}  // namespace raygrain
