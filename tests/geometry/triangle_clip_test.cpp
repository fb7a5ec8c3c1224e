// clip_triangle_bounds holds every point of the triangle in the box, decided exactly, and little more.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "raygrain/mesh.h"

#include "base/random.h"

namespace raygrain {
namespace {

/// Vertices on a grid of 2^12 steps: barycentric mixes with weights i / 64 are exact in double.
TriangleMesh grid_triangle(Random& random, float unit, bool flat) {
  TriangleMesh mesh;
  for (int i = 0; i < 3; ++i) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = unit * (static_cast<float>(random.below(4097)) - 2048);
    if (flat) p[static_cast<int>(random.below(3))] = 0;
    mesh.vertices.push_back(p);
  }
  if (random.below(8) == 0) mesh.vertices[2] = mesh.vertices[1];
  mesh.triangles.push_back({0, 1, 2});
  return mesh;
}

Bounds random_box(Random& random, const TriangleMesh& mesh, float unit) {
  Bounds box;
  for (int i = 0; i < 2; ++i) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] = unit * (static_cast<float>(random.below(4097)) - 2048);
      if (random.below(4) == 0) p[axis] = mesh.vertices[random.below(3)][axis];  // touches a vertex
      if (random.below(4) == 0) p[axis] = (i ? 1.0f : -1.0f) * 4096 * unit;      // does not cut
    }
    box.extend(p);
  }
  return box;
}

bool holds(const Bounds& b, Vec3d p) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(static_cast<double>(b.lo[axis]) <= p[axis] && p[axis] <= static_cast<double>(b.hi[axis]))) return false;
  return true;
}

TEST(ClipTriangleBounds, HoldsEveryPointOfTheTriangleInTheBox) {
  size_t inside = 0;
  for (uint64_t seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const float unit = std::ldexp(1.0f, static_cast<int>(random.below(200)) - 100);
    const TriangleMesh mesh = grid_triangle(random, unit, seed % 3 == 0);
    const Bounds box = random_box(random, mesh, unit), part = clip_triangle_bounds(mesh, 0, box);
    if (!is_empty(part)) {
      EXPECT_TRUE(contains(box, part));
      EXPECT_TRUE(contains(triangle_bounds(mesh, 0), part));
    }
    for (int i = 0; i <= 64; i += 4)
      for (int j = 0; i + j <= 64; j += 4) {
        const Vec3d p = (to_double(mesh.vertex(0, 0)) * i + to_double(mesh.vertex(0, 1)) * j +
                         to_double(mesh.vertex(0, 2)) * (64 - i - j)) *
                        (1.0 / 64);
        if (!holds(box, p)) continue;
        ++inside;
        ASSERT_TRUE(holds(part, p));
      }
  }
  EXPECT_GT(inside, 10000u);
}

TEST(ClipTriangleBounds, IsTight) {
  // A right triangle cut by x <= 3/4 and x >= 1/4: y reaches to 3/4 there.
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5f}}, {{0, 1, 2}}};
  const Bounds part = clip_triangle_bounds(mesh, 0, {{0.25f, -1, -1}, {0.75f, 1, 1}});
  EXPECT_EQ(part.lo, (Vec3{0.25f, 0, 0}));
  EXPECT_EQ(part.hi.x, 0.75f);
  EXPECT_NEAR(part.hi.y, 0.75f, 1e-6f);
  EXPECT_NEAR(part.hi.z, 0.375f, 1e-6f);
}

TEST(ClipTriangleBounds, IsEmptyOrNearlySoWhereTheyDoNotMeet) {
  // The box stands at the empty corner of the triangle's own box.
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  EXPECT_TRUE(is_empty(clip_triangle_bounds(mesh, 0, {{0.75f, 0.75f, -1}, {1, 1, 1}})));
  EXPECT_TRUE(is_empty(clip_triangle_bounds(mesh, 0, {{2, 2, 2}, {3, 3, 3}})));
  EXPECT_TRUE(is_empty(clip_triangle_bounds(mesh, 0, Bounds{})));
  // It touches the long edge in one point.
  EXPECT_TRUE(contains(clip_triangle_bounds(mesh, 0, {{0.5f, 0.5f, 0}, {1, 1, 0}}), Vec3{0.5f, 0.5f, 0}));
}

TEST(ClipTriangleBounds, TriangleInsideIsItsOwnBox) {
  const TriangleMesh mesh{{{0.1f, 0.2f, 0.3f}, {1, 0.7f, 0}, {0, 1, 0.9f}}, {{0, 1, 2}}};
  EXPECT_EQ(clip_triangle_bounds(mesh, 0, {{-1, -1, -1}, {2, 2, 2}}), triangle_bounds(mesh, 0));
}

TEST(ClipTriangleBounds, CopesWithExtremeCoordinates) {
  const float big = 3.4e38f, tiny = 1e-45f;
  const TriangleMesh mesh{{{-big, -big, 0}, {big, -big, tiny}, {0, big, -tiny}}, {{0, 1, 2}}};
  const Bounds part = clip_triangle_bounds(mesh, 0, {{-1, -1, -1}, {1, 1, 1}});
  EXPECT_EQ(part.lo.x, -1);
  EXPECT_EQ(part.hi.y, 1);
  EXPECT_TRUE(is_finite(part.lo) && is_finite(part.hi));
}

}  // namespace
}  // namespace raygrain
