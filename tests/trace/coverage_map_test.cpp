// The map of parallel rays: it turns with the scene, goes along its edges, and is a good one whatever it is given.
#include "trace/coverage_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "raygrain/frame.h"

#include "base/random.h"
#include "support/mesh_families.h"

namespace raygrain {
namespace {

using test::mesh_families;
using test::NamedMesh;

/// Boxes that stand on a floor, all turned alike within it, of which the light sees the tops and two sides.
TriangleMesh blocks(double turn) {
  Random random(3);
  TriangleMesh mesh;
  for (int k = 0; k < 40; ++k) {
    const Vec3d lo{random.uniform(-9, 9), 0, random.uniform(-9, 9)};
    const Vec3d size{random.uniform(0.5, 2), random.uniform(0.2, 1), random.uniform(0.5, 2)};
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    for (int c = 0; c < 8; ++c) {
      const Vec3d p = lo + Vec3d{c & 1 ? size.x : 0, c & 2 ? size.y : 0, c & 4 ? size.z : 0};
      mesh.vertices.push_back(to_float({std::cos(turn) * p.x - std::sin(turn) * p.z, p.y,  //
                                        std::sin(turn) * p.x + std::cos(turn) * p.z}));
    }
    for (const std::array<uint32_t, 4>& face :
         {std::array<uint32_t, 4>{2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}, {0, 4, 6, 2}, {1, 5, 7, 3}}) {
      const auto f = [&](size_t i) { return first + face[(i + static_cast<size_t>(k)) % 4]; };  // either diagonal
      mesh.triangles.push_back({f(0), f(1), f(2)});
      mesh.triangles.push_back({f(0), f(2), f(3)});
    }
  }
  return mesh;
}

double sine(Vec3d a, Vec3d b) {
  return length(cross(a, b)) / (length(a) * length(b));
}

TEST(CoverageMap, GoesAlongEdgesAndMeasuresDepthFromFloors) {
  const Vec3d light = normalized(Vec3d{0.4, -1, 0.3});
  for (const double turn : {0.0, 0.3, 1.0, 2.2}) {
    const ColumnMap map = choose_parallel_map(blocks(turn), to_float(light), {});
    // Along one pair of the blocks' edges x does not change, along the other y.
    const Vec3d along{std::cos(turn), 0, std::sin(turn)}, across{-std::sin(turn), 0, std::cos(turn)};
    const auto changes = [&](size_t row, Vec3d edge) { return std::abs(dot(normalized(map.rows[row]), edge)); };
    EXPECT_LT(
        std::max(std::min(changes(0, along), changes(1, along)), std::min(changes(0, across), changes(1, across))),
        1e-3)
        << turn;
    // All places of one height are as deep.
    EXPECT_LT(sine(map.rows[2], {0, 1, 0}), 1e-6) << turn;
  }
}

TEST(CoverageMap, TurnsWithTheScene) {
  const Vec3d light = normalized(Vec3d{0.4, -1, 0.3});
  const TriangleMesh scene = blocks(0.4);
  const ColumnMap still = choose_parallel_map(scene, to_float(light), {});
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    const Vec3d forward{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    const Frame axes = make_frame({}, forward, {random.uniform(-1, 1), 0.3, 1});
    TriangleMesh mesh = scene;
    for (Vec3& vertex : mesh.vertices) vertex = to_float(to_world_direction(axes, to_double(vertex)));
    const ColumnMap map = choose_parallel_map(mesh, to_float(to_world_direction(axes, light)), {});
    for (size_t row = 0; row < 3; ++row)
      EXPECT_LT(length(map.rows[row] - to_world_direction(axes, still.rows[row])), 5e-3)
          << "seed " << seed << ' ' << row;
  }
}

void expect_good_map(const TriangleMesh& mesh, Vec3 light) {
  const ColumnMap map = choose_parallel_map(mesh, light, {});
  const Vec3d along = normalized(to_double(light));
  const auto& [x, y, s] = map.rows;
  EXPECT_LT(std::max(std::abs(dot(x, along)), std::abs(dot(y, along))), 1e-12);
  EXPECT_LE(dot(s, along), -0.5);
  for (const Vec3d row : map.rows) EXPECT_LE(length(row), 1 + 1e-12);
  EXPECT_GE(std::min(length(x), length(y)), 0.25 - 1e-12);
  EXPECT_GE(sine(x, y), 0.25 - 1e-6);
}

// Whatever the mesh: columns stay columns, no row is long, and the three are far from lying in a plane.
TEST(CoverageMap, IsAGoodOneForAllFamilies) {
  for (uint64_t seed = 1; seed <= 10; ++seed)
    for (const NamedMesh& family : mesh_families(seed)) {
      SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
      Random random(seed);
      const Vec3d light{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      expect_good_map(family.mesh, to_float(light));
    }
}

/// Thin triangles from points of a square to a hair beside `along` from there.
TriangleMesh needles(Vec3 along) {
  Random random(4);
  TriangleMesh mesh;
  for (uint32_t i = 0; i < 50; ++i) {
    const Vec3 at = to_float({random.uniform(), 0, random.uniform()});
    mesh.vertices.insert(mesh.vertices.end(), {at, at + along, at + along + Vec3{1e-5f, 0, 0}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

// Edge-on, along the light, or all along one line: as good, and along that line, which turns with the scene.
TEST(CoverageMap, IsAGoodOneForEdgesAlongOneLine) {
  const Vec3 light{0, -1, 0};
  expect_good_map(needles({0, 1, 0}), light);
  expect_good_map({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, light);
  for (const double turn : {0.1, 0.9, 1.7, 2.8}) {
    const Vec3d along{std::cos(turn), 0.2, std::sin(turn)};
    const TriangleMesh mesh = needles(to_float(along));
    expect_good_map(mesh, light);
    const ColumnMap map = choose_parallel_map(mesh, light, {});
    const Vec3d flat{along.x, 0, along.z};
    EXPECT_LT(std::min(std::abs(dot(map.rows[0], flat)), std::abs(dot(map.rows[1], flat))), 0.02) << turn;
  }
}

}  // namespace
}  // namespace raygrain
