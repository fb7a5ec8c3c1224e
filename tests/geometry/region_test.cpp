#include "raygrain/region.h"

#include <gtest/gtest.h>

#include "geometry/region_support.h"

namespace raygrain {
namespace {

using test::diameter;
using test::point_inside;
using test::random_region;
using test::random_vector;

TEST(Region, CornersLieOnThreePlanesEach) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const ConvexRegion region = random_region(seed);
    for (size_t i = 0; i < 8; ++i) {
      int touching = 0, touching_outer = 0;
      for (const Plane& plane : region.planes) {
        const double height = dot(plane.normal, region.corners[i]) - plane.offset;
        const double outer = dot(plane.normal, region.outer_corners[i]) - plane.offset - 2 * region.slack;
        EXPECT_LE(height, 0.001 * region.slack);
        EXPECT_LE(outer, 0.001 * region.slack);
        touching += height > -0.001 * region.slack;
        touching_outer += outer > -0.001 * region.slack;
      }
      EXPECT_EQ(touching, 3);
      EXPECT_EQ(touching_outer, 3);
    }
  }
}

TEST(Region, SlackExceedsRoundingOfFloatInput) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const ConvexRegion region = random_region(seed);
    double coordinate = 0;
    for (const Vec3d c : region.corners)
      for (int k = 0; k < 3; ++k) coordinate = std::fmax(coordinate, std::fabs(c[k]));
    EXPECT_GT(region.slack, 8 * coordinate * 0x1p-24);
    EXPECT_LT(region.slack, 4e-6 * (coordinate + diameter(region)));
    for (const Vec3d c : region.corners) EXPECT_TRUE(contains(region, to_float(c)));
  }
}

TEST(Region, ContainsAgreesWithConvexCombinations) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const ConvexRegion region = random_region(seed);
    Random random(seed);
    const Vec3d middle = region.corners[0] * 0.5 + region.corners[7] * 0.5;
    for (int i = 0; i < 100; ++i) {
      const Vec3d inside = point_inside(region, random);
      EXPECT_TRUE(contains(region, to_float(inside)));
      // A point beyond a plane is outside.
      const Plane& plane = region.planes[random.below(6)];
      const double height = plane.offset - dot(plane.normal, inside);
      EXPECT_FALSE(contains(region, to_float(inside + plane.normal * (height + 2.5 * region.slack))));
    }
    EXPECT_TRUE(contains(region, to_float(middle)));
    EXPECT_FALSE(contains(region, {NAN, 0, 0}));
    EXPECT_FALSE(contains(region, {kInf, 0, 0}));
  }
}

TEST(Region, BoundsContainCornersAndContainedPoints) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const ConvexRegion region = random_region(seed);
    const Bounds bounds = region_bounds(region);
    Random random(seed);
    for (const Vec3d c : region.corners)
      for (int k = 0; k < 3; ++k) {
        EXPECT_LE(static_cast<double>(bounds.lo[k]), c[k]);
        EXPECT_GE(static_cast<double>(bounds.hi[k]), c[k]);
      }
    for (int i = 0; i < 100; ++i) {
      const Vec3d p = region.corners[random.below(8)] + random_vector(random) * (3 * region.slack);
      if (contains(region, to_float(p))) {
        EXPECT_TRUE(contains(bounds, to_float(p)));
      }
    }
  }
}

TEST(Region, BoundsOfHugeRegionStayFinite) {
  const ConvexRegion region = frustum_region({}, 1e7, 1, 1, 3e38);
  const Bounds bounds = region_bounds(region);
  EXPECT_TRUE(is_finite(bounds.lo));
  EXPECT_TRUE(is_finite(bounds.hi));
}

TEST(Region, EnclosesImpliesContainsAndOverlaps) {
  int enclosed = 0, not_enclosed = 0;
  for (uint64_t seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const ConvexRegion region = random_region(seed);
    Random random(seed);
    Bounds box;
    const Vec3d middle = point_inside(region, random);
    const double size = diameter(region) * std::pow(10.0, random.uniform(-4, 0));
    box.extend(to_float(middle + random_vector(random) * size));
    box.extend(to_float(middle + random_vector(random) * size));
    bool all = true, none_far_out = true;
    for (int i = 0; i < 8; ++i) {
      all = all && contains(region, corner(box, i));
      for (const Plane& plane : region.planes)
        none_far_out = none_far_out && dot(plane.normal, to_double(corner(box, i))) < plane.offset - region.slack;
    }
    if (encloses(region, box)) {
      EXPECT_TRUE(all);
      EXPECT_TRUE(overlaps(region, box));
      ++enclosed;
    } else {
      EXPECT_FALSE(none_far_out);
      ++not_enclosed;
    }
    EXPECT_FALSE(encloses(region, Bounds{}));
    EXPECT_FALSE(overlaps(region, Bounds{}));
  }
  EXPECT_GT(enclosed, 100);
  EXPECT_GT(not_enclosed, 100);
}

TEST(Region, BoxEnclosesItself) {
  const Bounds box{{-1, -2, -3}, {4, 5, 6}};
  EXPECT_TRUE(encloses(box_region(box), box));
  EXPECT_TRUE(overlaps(box_region(box), box));
}

TEST(Region, BoxesThatTouchOverlap) {
  const ConvexRegion region = box_region({{0, 0, 0}, {1, 1, 1}});
  EXPECT_TRUE(overlaps(region, Bounds{{1, 0, 0}, {2, 1, 1}}));
  EXPECT_TRUE(overlaps(region, Bounds{{1, 1, 1}, {2, 2, 2}}));
  EXPECT_FALSE(overlaps(region, Bounds{{1.001f, 0, 0}, {2, 1, 1}}));
  EXPECT_TRUE(overlaps(region, Bounds{{-kInf, -kInf, -kInf}, {kInf, kInf, kInf}}));
}

}  // namespace
}  // namespace raygrain
