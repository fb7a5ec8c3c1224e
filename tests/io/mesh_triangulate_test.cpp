#include <cmath>

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/trigonometry.h"
#include "io/mesh_polygons.h"
#include "mesh_files.h"

namespace raygrain {
namespace {

PolygonMesh one_polygon(std::vector<Vec3> vertices) {
  PolygonMesh mesh;
  mesh.sizes = {static_cast<uint32_t>(vertices.size())};
  for (uint32_t i = 0; i < vertices.size(); ++i) mesh.corners.push_back(i);
  mesh.vertices = std::move(vertices);
  return mesh;
}

Vec3d area_vector(const TriangleMesh& mesh, size_t triangle) {
  const Vec3d a = to_double(mesh.vertex(triangle, 0));
  return cross(to_double(mesh.vertex(triangle, 1)) - a, to_double(mesh.vertex(triangle, 2)) - a);
}

// In a valid triangulation every triangle turns the polygon's way and the areas add up.
void expect_covers(const TriangleMesh& mesh, Vec3d twice_area) {
  double sum = 0;
  for (size_t i = 0; i < mesh.triangle_count(); ++i) {
    EXPECT_GE(dot(area_vector(mesh, i), twice_area), 0) << "triangle " << i;
    sum += length(area_vector(mesh, i));
  }
  EXPECT_NEAR(sum, length(twice_area), 1e-9 * length(twice_area));
}

Vec3d polygon_area(const std::vector<Vec3>& points) {
  Vec3d sum;
  for (size_t i = 0; i < points.size(); ++i)
    sum = sum + cross(to_double(points[i]), to_double(points[(i + 1) % points.size()]));
  return sum;
}

TEST(Triangulate, ConvexPolygonsAreFans) {
  const TriangleMesh mesh = triangulated(one_polygon({{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {0, 2, 0}}), "a");
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(Triangulate, ConcaveQuadsAreSplitInside) {
  const std::vector<Vec3> arrow{{0, 0, 0}, {2, -1, 0}, {0.5f, 0, 0}, {2, 1, 0}};
  for (size_t turn = 0; turn < 4; ++turn) {
    SCOPED_TRACE(turn);
    std::vector<Vec3> turned(arrow.begin() + static_cast<std::ptrdiff_t>(turn), arrow.end());
    turned.insert(turned.end(), arrow.begin(), arrow.begin() + static_cast<std::ptrdiff_t>(turn));
    const TriangleMesh mesh = triangulated(one_polygon(turned), "a");
    ASSERT_EQ(mesh.triangle_count(), 2u);
    expect_covers(mesh, polygon_area(turned));
  }
}

// Star-shaped polygons with random radii, in random planes, in both senses.
TEST(Triangulate, ConcavePolygonsAreCovered) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const size_t corners = 4 + random.below(60);
    const int u = static_cast<int>(random.below(3)), v = (u + 1 + static_cast<int>(random.below(2))) % 3;
    std::vector<Vec3> points;
    for (size_t i = 0; i < corners; ++i) {
      // Coordinates on a grid of 2^-10 around the origin, so that all areas are exact.
      const SineCosine turn = sine_cosine(radians(360.0 * static_cast<double>(i) / static_cast<double>(corners)));
      const double radius = random.uniform(0.5, 4);
      Vec3 point;
      point[u] = static_cast<float>(std::round(radius * turn.cosine * 1024) / 1024);
      point[v] = static_cast<float>(std::round(radius * turn.sine * 1024) / 1024);
      point[3 - u - v] = 1;
      points.push_back(point);
    }
    const TriangleMesh mesh = triangulated(one_polygon(points), "a");
    ASSERT_EQ(mesh.triangle_count(), corners - 2);
    Vec3d area = polygon_area(points);
    area[u] = area[v] = 0;
    expect_covers(mesh, area);
  }
}

TEST(Triangulate, AnyPolygonGivesTwoTrianglesFewerThanCorners) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<Vec3> points(3 + random.below(40));
    for (Vec3& point : points)
      for (int axis = 0; axis < 3; ++axis) point[axis] = static_cast<float>(random.below(seed % 5 + 1));
    const TriangleMesh mesh = triangulated(one_polygon(points), "a");
    ASSERT_EQ(mesh.triangle_count(), points.size() - 2);
    for (const auto& triangle : mesh.triangles)
      EXPECT_TRUE(triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0]);
  }
  const TriangleMesh huge = triangulated(one_polygon({{3e38f, 0, 0}, {0, 3e38f, 0}, {-3e38f, 0, 0}, {0, 1, 0}}), "a");
  EXPECT_EQ(huge.triangle_count(), 2u);
}

TEST(Triangulate, OrderIsTheFilesOrder) {
  PolygonMesh mesh;
  for (int i = 0; i < 6; ++i) mesh.vertices.push_back({static_cast<float>(i), static_cast<float>(i * i), 0});
  mesh.sizes = {3, 4, 3};
  mesh.corners = {5, 4, 3, 0, 1, 2, 3, 0, 0, 0};
  const TriangleMesh result = triangulated(mesh, "a");
  EXPECT_EQ(result.triangles, (std::vector<std::array<uint32_t, 3>>{{5, 4, 3}, {0, 1, 2}, {0, 2, 3}, {0, 0, 0}}));
}

TEST(Triangulate, GiantsThatAreNotConvexAreRefused) {
  std::vector<Vec3> zigzag;
  for (int i = 0; i < 30000; ++i) zigzag.push_back({static_cast<float>(i), static_cast<float>(i % 2), 0});
  zigzag.push_back({0, -10, 0});
  EXPECT_EQ(test::error_of([&] { triangulated(one_polygon(zigzag), "a"); }).code, ErrorCode::kLimit);
}

TEST(Weld, MergesOnlyEqualBits) {
  TriangleMesh mesh{{{9, 9, 9}, {0, 0, 0}, {-0.0f, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}}, {{1, 2, 3}, {4, 5, 2}}};
  const TriangleMesh result = welded(mesh);
  EXPECT_TRUE(test::same_bits(result.vertices, {{0, 0, 0}, {-0.0f, 0, 0}, {1, 0, 0}}));
  EXPECT_EQ(result.triangles, (std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {0, 2, 1}}));
}

}  // namespace
}  // namespace raygrain
