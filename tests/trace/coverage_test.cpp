// Coverage grids on every instruction set against brute force, bit for bit: rays of a sun and of a point, aimed at
// edges, vertices and silhouettes, and through eyes' wide windows. coverage_border_test.cpp has the borders.
#include "raygrain/coverage.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/trace.h"

#include "base/random.h"
#include "support/mesh_families.h"
#include "trace/coverage_answers.h"

namespace raygrain {
namespace {

using test::expect_flags;
using test::expect_hits;
using test::expect_same_singly;
using test::for_families;
using test::oracle_flags;
using test::oracle_hits;
using test::Tally;

Vec3 unit_vector(Random& random) {
  while (true) {
    const Vec3d v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    if (dot(v, v) > 0.01 && dot(v, v) <= 1) return to_float(normalized(v));
  }
}

Vec3 vertex(const TriangleMesh& mesh, Random& random) {
  return mesh.vertex(random.below(mesh.triangle_count()), static_cast<int>(random.below(3)));
}

/// A point of the mesh: a vertex, on an edge, or inside a triangle; rounded.
Vec3 point_on(const TriangleMesh& mesh, Random& random) {
  const size_t t = random.below(mesh.triangle_count());
  const Vec3d a = to_double(mesh.vertex(t, 0)), b = to_double(mesh.vertex(t, 1)), c = to_double(mesh.vertex(t, 2));
  const double u = random.below(3) == 0 ? 0 : random.uniform(),
               v = random.below(3) == 0 ? 0 : random.uniform() * (1 - u);
  return to_float(a + (b - a) * u + (c - a) * v);
}

/// Origins of rays along `direction`: on the mesh, before and behind it, near and far, and some that mean nothing.
std::vector<Vec3> origins_along(const TriangleMesh& mesh, Vec3 direction, size_t count, Random& random) {
  const Bounds box = mesh_bounds(mesh);
  const double size = length(to_double(extent(box)));
  std::vector<Vec3> points;
  for (size_t i = 0; i < count; ++i) {
    Vec3d p = to_double(point_on(mesh, random));
    const double shifts[] = {0, 1e-6, -1e-6, 1e-4, -1e-4, 0.1, -0.1, 1, -1, -1, 0.6, -0.6, 30};
    p = p + to_double(direction) * (size * shifts[random.below(std::size(shifts))]);
    if (random.below(4) == 0) p = p + to_double(unit_vector(random)) * (size * 1e-7);
    if (random.below(4) == 0) p = to_double(box.lo) + (to_double(extent(box)) * 1.2) * random.uniform();
    points.push_back(to_float(p));
  }
  points.push_back({std::nanf(""), 0, 0});
  points.push_back({0, kInf, 0});
  return points;
}

std::vector<Vec3> points_around(const TriangleMesh& mesh, Vec3 eye, size_t count, Random& random) {
  const double size = length(to_double(extent(mesh_bounds(mesh)))) + 1e-30;
  std::vector<Vec3> points{eye, {std::nanf(""), 0, 0}, {kInf, 0, 0}};
  for (size_t i = 0; i < count; ++i) {
    const Vec3d p = to_double(point_on(mesh, random)), away = p - to_double(eye);
    const double factors[] = {1, 1, 1.0001, 0.9999, 1.5, 0.5, 0.01, 3};
    Vec3d q = to_double(eye) + away * factors[random.below(std::size(factors))];
    if (random.below(4) == 0) q = q + to_double(unit_vector(random)) * (size * 1e-6);
    if (random.below(8) == 0)
      q.x = static_cast<double>(eye.x) + std::abs(q.z - static_cast<double>(eye.z));  // between two frusta
    points.push_back(to_float(q));
  }
  return points;
}

std::vector<Vec3> light_directions(Random& random) {
  const Vec3 any = unit_vector(random);
  Vec3 axis{};
  axis[static_cast<int>(random.below(3))] = random.below(2) == 0 ? 1.0f : -1.0f;
  return {axis, any, {any.x, 1e-4f * any.y, any.z * 1e-7f}};
}

CoverageOptions some_options(uint64_t seed, Isa isa, Random& random) {
  const float cells[] = {0.25f, 4, 64};
  const uint32_t triangles[] = {256, 16, 4};
  const CoverageOrder order = kCoverageOrders[random.below(std::size(kCoverageOrders))];
  return {cells[seed % 3], triangles[(seed / 3 + seed) % 3], isa, order, 1};
}

TEST(Coverage, AgreesWithTheOracleAlongADirection) {
  Tally any, nearest;
  for_families(2, [&](const std::shared_ptr<const TriangleMesh>& mesh, uint64_t seed) {
    Random random(seed + 100);
    const Bounds box = mesh_bounds(*mesh);
    for (const Vec3 light : light_directions(random)) {
      const InfluenceArea area = directional_light_area("sun", light, box);
      const std::vector<Vec3> origins = origins_along(*mesh, light, test::seed_count(120), random);
      std::vector<Ray> towards, away;
      for (const Vec3 p : origins) towards.push_back({p, -light, 0, kInf}), away.push_back({p, light, 0, kInf});
      const std::vector<uint8_t> expected_flags = oracle_flags(*mesh, towards);
      const std::vector<Hit> expected_hits = oracle_hits(*mesh, away);
      for (const Isa isa : supported_isas()) {
        SCOPED_TRACE(name(isa));
        const Coverage coverage(mesh, area, some_options(seed, isa, random));
        std::vector<uint32_t> rest;
        std::vector<uint8_t> flags(origins.size());
        coverage.occluded(origins, -light, flags, rest);
        expect_flags(expected_flags, flags, rest, any);
        expect_same_singly(coverage, towards, flags, rest);
        rest.clear();
        std::vector<Hit> hits(origins.size());
        coverage.intersect(origins, light, hits, rest);
        expect_hits(expected_hits, hits, rest, nearest);
        expect_same_singly(coverage, away, hits, rest);
        if (testing::Test::HasFatalFailure()) return;
      }
    }
  });
  // Rays of every kind are answered by coverage: so much at each scale of the test.
  EXPECT_GT(any.answered, any.asked / 2);
  EXPECT_GT(any.hits, any.answered / 10);
  EXPECT_GT(nearest.answered, nearest.asked / 10);
  EXPECT_GT(nearest.hits, nearest.answered / 4);
}

// Each cell would list thousands of triangles.
TEST(Coverage, LeavesManyLayersOfLargeTrianglesUncovered) {
  Random random(7);
  const auto mesh = std::make_shared<TriangleMesh>();
  const auto coordinate = [&] { return static_cast<float>(random.uniform()); };
  for (uint32_t i = 0; i < 20'000; ++i) {
    for (int corner = 0; corner < 3; ++corner) mesh->vertices.push_back({coordinate(), coordinate(), coordinate()});
    mesh->triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const Vec3 light{0.3f, -1, 0.1f};
  const Coverage coverage(mesh, directional_light_area("sun", light, mesh_bounds(*mesh)));
  EXPECT_FALSE(coverage.is_useful());
  EXPECT_FALSE(coverage.occluded(Ray{{0.5f, 0.5f, 0.5f}, -light}));
}

/// An eye that sees nearly half of everything.
InfluenceArea wide_area(Vec3 eye, Vec3 forward, float fov, double reach) {
  return {
      "wide " + std::to_string(fov),
      PointArea{eye, forward, {0, 1, 0}, fov, fov, static_cast<float>(1e-3 * reach), static_cast<float>(3 * reach)}};
}

TEST(Coverage, AgreesWithTheOracleAboutAPoint) {
  Tally any, nearest, wide;
  size_t eye_number = 0;
  for_families(2, [&](const std::shared_ptr<const TriangleMesh>& mesh, uint64_t seed) {
    Random random(seed + 200);
    const Bounds box = mesh_bounds(*mesh);
    const Vec3d size = to_double(extent(box));
    const double reach = length(size);
    const Vec3d middle = to_double(center(box));
    const Vec3 eyes[] = {
        to_float(middle + to_double(unit_vector(random)) * (reach * 0.9)),
        to_float(to_double(box.lo) +
                 Vec3d{size.x * random.uniform(), size.y * random.uniform(), size.z * random.uniform()}),
        vertex(*mesh, random),
        to_float(to_double(point_on(*mesh, random)) + to_double(unit_vector(random)) * (reach * 1e-8))};
    for (const Vec3 eye : eyes) {
      const std::vector<Vec3> points = points_around(*mesh, eye, test::seed_count(100), random);
      std::vector<Vec3> directions;
      std::vector<Ray> towards, from;
      for (const Vec3 p : points) {
        directions.push_back(p - eye);
        towards.push_back({p, eye - p, 0, 1}), from.push_back({eye, p - eye, 0, kInf});
      }
      const std::vector<uint8_t> expected_flags = oracle_flags(*mesh, towards);
      const std::vector<Hit> expected_hits = oracle_hits(*mesh, from);
      std::vector<InfluenceArea> areas = point_light_areas("lamp", eye, box);
      constexpr float kWideFields[] = {170, 179, 179.9f};
      const Vec3d forward = middle - to_double(eye) + to_double(unit_vector(random)) * (0.1 * reach);
      if (reach > 0) areas.push_back(wide_area(eye, to_float(forward), kWideFields[eye_number++ % 3], reach));
      for (const InfluenceArea& area : areas)
        for (const Isa isa : supported_isas()) {
          SCOPED_TRACE(area.name + ", " + name(isa));
          const Coverage coverage(mesh, area, some_options(seed, isa, random));
          std::vector<uint32_t> rest;
          std::vector<uint8_t> flags(points.size());
          coverage.occluded_towards(points, eye, flags, rest);
          expect_flags(expected_flags, flags, rest, any);
          expect_same_singly(coverage, towards, flags, rest);
          rest.clear();
          std::vector<Hit> hits(points.size());
          coverage.intersect_from(eye, directions, hits, rest);
          expect_hits(expected_hits, hits, rest, area.name.starts_with("wide") ? wide : nearest);
          expect_same_singly(coverage, from, hits, rest);
          if (testing::Test::HasFatalFailure()) return;
        }
    }
  });
  EXPECT_GT(any.answered, any.asked / 12);  // a sixth is in each frustum
  EXPECT_GT(any.hits, any.answered / 8);
  EXPECT_GT(nearest.answered, nearest.asked / 12);
  EXPECT_GT(nearest.hits, nearest.answered / 3);
  EXPECT_GT(wide.answered, wide.asked / 8);
  EXPECT_GT(wide.hits, wide.answered / 8);
}

}  // namespace
}  // namespace raygrain
