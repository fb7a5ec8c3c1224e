#include <gtest/gtest.h>

#include "raygrain/region.h"

#include "geometry/region_support.h"

namespace raygrain {
namespace {

using test::clipped_overlap;
using test::diameter;
using test::point_inside;
using test::random_region;
using test::random_vector;

// Compares with clipping, which must agree except where the distance is about the margin itself.
void expect_same_as_clipping(const ConvexRegion& region, Vec3 a, Vec3 b, Vec3 c, int counts[2]) {
  const std::vector<Vec3d> polygon{to_double(a), to_double(b), to_double(c)};
  const bool answer = overlaps(region, a, b, c);
  if (clipped_overlap(region, polygon, 1.9 * region.slack)) {
    EXPECT_TRUE(answer);
  }
  if (!clipped_overlap(region, polygon, 2.1 * region.slack)) {
    EXPECT_FALSE(answer);
  }
  ++counts[answer];
}

TEST(RegionOverlap, TrianglesAgreeWithClipping) {
  int counts[2] = {0, 0};
  for (uint64_t seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const ConvexRegion region = random_region(seed);
    Random random(seed);
    for (int i = 0; i < 10; ++i) {
      const double far = diameter(region) * std::pow(10.0, random.uniform(-3, 1));
      const double size = diameter(region) * std::pow(10.0, random.uniform(-3, 1));
      const Vec3d at = point_inside(region, random) + random_vector(random) * far;
      expect_same_as_clipping(region, to_float(at), to_float(at + random_vector(random) * size),
                              to_float(at + random_vector(random) * size), counts);
    }
  }
  EXPECT_GT(counts[0], 3000);
  EXPECT_GT(counts[1], 3000);
}

// Triangles that pass just outside or just inside an edge or corner: only the crossed axes can separate them.
TEST(RegionOverlap, TrianglesNearEdgesAgreeWithClipping) {
  int counts[2] = {0, 0};
  for (uint64_t seed = 1; seed <= 4000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const ConvexRegion region = random_region(seed);
    Random random(seed);
    const size_t first = random.below(8), second = first ^ (size_t{1} << random.below(3));
    const Vec3d middle = region.corners[0] * 0.5 + region.corners[7] * 0.5;
    const Vec3d on_edge = region.corners[first] + (region.corners[second] - region.corners[first]) * random.uniform();
    const Vec3d at = on_edge + (on_edge - middle) * random.uniform(-0.05, 0.05);
    const Vec3d direction = random_vector(random) * diameter(region), other = random_vector(random) * diameter(region);
    expect_same_as_clipping(region, to_float(at - direction), to_float(at + direction), to_float(at + other * 3.0),
                            counts);
  }
  EXPECT_GT(counts[0], 200);
  EXPECT_GT(counts[1], 1000);
}

TEST(RegionOverlap, DegenerateTrianglesAreWhatTheyAre) {
  for (uint64_t seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const ConvexRegion region = random_region(seed);
    Random random(seed);
    int counts[2] = {0, 0};
    const Vec3d at = point_inside(region, random) + random_vector(random) * (0.7 * diameter(region));
    const Vec3 p = to_float(at), q = to_float(at + random_vector(random) * diameter(region));
    expect_same_as_clipping(region, p, p, p, counts);
    expect_same_as_clipping(region, p, q, p, counts);
    expect_same_as_clipping(region, p, p * 0.5f + q * 0.5f, q, counts);
  }
}

TEST(RegionOverlap, HugeTrianglesNeverGetAWrongNo) {
  for (uint64_t seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const ConvexRegion region = random_region(seed);
    Random random(seed);
    // A point inside, and a triangle in the plane x = const (y, z) through it: no rounding anywhere.
    const Vec3d inside = point_inside(region, random);
    const Vec3 p = to_float(inside);
    for (const float size : {1e3f, 1e10f, 1e20f, 1e30f, 3e38f})
      for (int axis = 0; axis < 3; ++axis) {
        std::array<Vec3, 3> vertices{Vec3{-size, -size, -size}, Vec3{size, size, size}, Vec3{}};
        vertices[1][(axis + 1) % 3] = -size;
        vertices[2][(axis + 1) % 3] = size;
        for (Vec3& vertex : vertices) vertex[axis] = p[axis];
        if (static_cast<double>(size) < 10 * (length(inside) + diameter(region))) continue;
        EXPECT_TRUE(overlaps(region, vertices[0], vertices[1], vertices[2])) << size;
      }
    // A vertex inside decides whatever the others are.
    const float m = std::numeric_limits<float>::max();
    EXPECT_TRUE(overlaps(region, to_float(inside), {m, -m, m}, {-m, m, m}));
    EXPECT_TRUE(overlaps(region, {m, m, m}, to_float(inside), {m, m, -m}));
    EXPECT_FALSE(overlaps(region, {m, m, m}, {m, -m, m}, {m, m / 2, -m}));
  }
}

// Slanted triangles whose middle is exactly the origin, which is inside: their projections are all rounding.
TEST(RegionOverlap, HugeSlantedTrianglesNeverGetAWrongNo) {
  for (uint64_t seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    Frame frame = make_frame({}, random_vector(random), random_vector(random));
    frame.origin = frame.forward * -0.5;
    const ConvexRegion box = oriented_box_region(frame, 0.3, 0.4, 1);
    const ConvexRegion frustum = frustum_region(frame, 0.3, 0.4, 0.1, 1);
    const auto whole = [&] { return static_cast<float>(random.below(0x1000000)) - 0x800000; };
    const Vec3 u{whole(), whole(), whole()}, v{whole(), whole(), whole()};
    for (const float size : {0x1p-20f, 1.0f, 0x1p40f, 0x1p80f, 0x1p103f}) {
      const Vec3 a = u * size, b = v * size, c = (-u - v) * size;
      EXPECT_TRUE(overlaps(box, a, b, c)) << size;
      EXPECT_TRUE(overlaps(frustum, a, b, c)) << size;
    }
  }
}

TEST(RegionOverlap, TouchingTrianglesOverlap) {
  const ConvexRegion region = box_region({{0, 0, 0}, {1, 1, 1}});
  EXPECT_TRUE(overlaps(region, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}));           // a vertex on a corner
  EXPECT_TRUE(overlaps(region, {1, -5, -5}, {1, 5, -5}, {1, 0, 5}));        // in the plane of a face
  EXPECT_TRUE(overlaps(region, {1, -5, 2}, {1, 5, 0}, {3, 0, 1}));          // an edge that grazes a face
  EXPECT_TRUE(overlaps(region, {2, 0, 0.5f}, {0, 2, 0.5f}, {3, 3, 0.5f}));  // an edge across an edge
  EXPECT_FALSE(overlaps(region, {2.01f, 0, 0.5f}, {0, 2.01f, 0.5f}, {3, 3, 0.5f}));
  EXPECT_TRUE(overlaps(region, {-9, -9, 0.5f}, {9, -9, 0.5f}, {0, 20, 0.5f}));  // around the box
}

TEST(RegionOverlap, BoxesAgreeWithClippedFaces) {
  int counts[2] = {0, 0};
  for (uint64_t seed = 1; seed <= 5000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const ConvexRegion region = random_region(seed);
    Random random(seed);
    const Vec3d at = point_inside(region, random) +
                     random_vector(random) * (diameter(region) * std::pow(10.0, random.uniform(-2, 0)));
    Bounds box;
    for (int i = 0; i < 2; ++i)
      box.extend(to_float(at + random_vector(random) * (diameter(region) * std::pow(10.0, random.uniform(-3, 0)))));
    const auto overlaps_by_faces = [&](double margin) {
      constexpr int kFaces[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
      for (const auto& face : kFaces) {
        std::vector<Vec3d> polygon;
        for (const int i : face) polygon.push_back(to_double(corner(box, i)));
        if (clipped_overlap(region, polygon, margin)) return true;
      }
      return contains(box, to_float(region.corners[0]));  // the region inside the box
    };
    const bool answer = overlaps(region, box);
    if (overlaps_by_faces(1.9 * region.slack)) {
      EXPECT_TRUE(answer);
    }
    if (!overlaps_by_faces(2.1 * region.slack)) {
      EXPECT_FALSE(answer);
    }
    ++counts[answer];
  }
  EXPECT_GT(counts[0], 500);
  EXPECT_GT(counts[1], 500);
}

}  // namespace
}  // namespace raygrain
