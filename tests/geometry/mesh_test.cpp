#include "raygrain/mesh.h"

#include <limits>

#include <gtest/gtest.h>

#include "raygrain/error.h"

namespace raygrain {
namespace {

TriangleMesh two_triangles() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {9, 9, 9}}, {{{0, 1, 2}}, {{0, 2, 3}}}};
}

TEST(Mesh, BoxesAndBarycentresOfTriangles) {
  const TriangleMesh mesh = two_triangles();
  EXPECT_EQ(triangle_bounds(mesh, 0), (Bounds{{0, 0, 0}, {1, 2, 0}}));
  EXPECT_EQ(triangle_centroid(mesh, 1), (Vec3{0, static_cast<float>(2.0 / 3), 1}));
  EXPECT_EQ(triangle_bounds(mesh).size(), 2u);
  EXPECT_EQ(triangle_centroids(mesh)[0], triangle_centroid(mesh, 0));
}

TEST(Mesh, BoundsIgnoreUnusedVertices) {
  EXPECT_EQ(mesh_bounds(two_triangles()), (Bounds{{0, 0, 0}, {1, 2, 3}}));
  EXPECT_TRUE(is_empty(mesh_bounds(TriangleMesh{})));
}

TEST(Mesh, CentroidsOfHugeTrianglesAreFinite) {
  const float huge = std::numeric_limits<float>::max();
  const TriangleMesh mesh{{{huge, huge, huge}, {huge, -huge, huge}, {huge, huge, -huge}}, {{{0, 1, 2}}}};
  EXPECT_TRUE(is_finite(triangle_centroid(mesh, 0)));
}

TEST(Mesh, ValidationNamesTheFirstFault) {
  EXPECT_NO_THROW(validate(two_triangles(), "mesh"));
  TriangleMesh mesh = two_triangles();
  mesh.triangles[1][2] = 5;
  try {
    validate(mesh, "bad.obj");
    FAIL() << "an index out of range was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::kBadMesh);
    EXPECT_EQ(error.where, "bad.obj");
    EXPECT_EQ(error.message, "triangle 1 uses vertex 5 of 5");
  }
  mesh = two_triangles();
  mesh.vertices[3].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(validate(mesh, "bad.obj"), Error);
}

TEST(Bounds, EmptyIsNeutral) {
  Bounds box;
  EXPECT_TRUE(is_empty(box));
  box.extend(Vec3{1, 2, 3});
  EXPECT_EQ(box, (Bounds{{1, 2, 3}, {1, 2, 3}}));
  EXPECT_EQ(united(box, Bounds{}), box);
  EXPECT_TRUE(is_empty(intersected(box, Bounds{{2, 2, 2}, {3, 3, 3}})));
  EXPECT_TRUE(contains(Bounds{{0, 0, 0}, {3, 3, 3}}, box));
  EXPECT_FALSE(contains(box, Bounds{{0, 0, 0}, {3, 3, 3}}));
}

TEST(Bounds, CornersAndAxes) {
  const Bounds box{{0, 0, 0}, {1, 2, 3}};
  EXPECT_EQ(corner(box, 0), box.lo);
  EXPECT_EQ(corner(box, 7), box.hi);
  EXPECT_EQ(corner(box, 5), (Vec3{1, 0, 3}));
  EXPECT_EQ(longest_axis(box), 2);
  EXPECT_EQ(longest_axis(Bounds{{0, 0, 0}, {2, 2, 1}}), 0);
  EXPECT_EQ(center(box), (Vec3{0.5f, 1, 1.5f}));
}

}  // namespace
}  // namespace raygrain
