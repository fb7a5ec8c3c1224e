// Closed meshes have no gaps: not at edges, not at vertices, at no scale.
#include <gtest/gtest.h>

#include "raygrain/trace.h"
#include "raygrain/triangle.h"

#include "base/random.h"
#include "support/mesh_families.h"
#include "trace/hand_made_trees.h"

namespace raygrain {
namespace {

using test::NamedMesh;

Vec3 between(Vec3 a, Vec3 b, double share) {
  return to_float(to_double(a) + (to_double(b) - to_double(a)) * share);
}

template <class Body>
void for_closed_meshes(uint64_t seeds, const Body& body) {
  for (uint64_t seed = 0; seed < test::seed_count(seeds); ++seed)
    for (const NamedMesh& family : test::mesh_families(seed)) {
      if (!family.closed) continue;
      SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
      body(family, seed);
      if (testing::Test::HasFatalFailure()) return;
    }
}

// A few points well inside, each aimed at every vertex, the middle of every edge, and more points of every edge.
TEST(Watertight, NoRayLeaksThroughEdgesOrVertices) {
  size_t rays = 0;
  for_closed_meshes(4, [&](const NamedMesh& family, uint64_t seed) {
    const TriangleMesh& mesh = family.mesh;
    const Bvh bvh = test::hand_made_trees(mesh)[1].bvh;
    Random random(seed);
    for (int start = 0; start < 4; ++start) {
      const Vec3 towards = mesh.vertices[random.below(mesh.vertices.size())];
      const Vec3 origin = start == 0 ? family.inside : between(family.inside, towards, random.uniform(0, 0.05));
      const auto expect_hit = [&](Vec3 target) {
        ++rays;
        const Vec3 direction = target - origin;
        ASSERT_TRUE(occluded(bvh, mesh, {origin, direction}));
        ASSERT_TRUE(is_hit(intersect(bvh, mesh, {origin, direction})));
        ASSERT_TRUE(occluded(bvh, mesh, {origin, -direction}));
      };
      for (const Vec3 vertex : mesh.vertices) ASSERT_NO_FATAL_FAILURE(expect_hit(vertex));
      for (size_t i = 0; i < mesh.triangle_count(); ++i)
        for (int k = 0; k < 3; ++k)
          for (const double share : {0.5, random.uniform(), 1 - random.uniform() * 1e-7})
            ASSERT_NO_FATAL_FAILURE(expect_hit(between(mesh.vertex(i, k), mesh.vertex(i, (k + 1) % 3), share)));
    }
  });
  EXPECT_GT(rays, test::seed_count(4) * 50000);
}

TEST(Watertight, NoRayLeaksAtRandomOrAlongAxes) {
  for_closed_meshes(4, [&](const NamedMesh& family, uint64_t seed) {
    const Bvh bvh = test::hand_made_trees(family.mesh)[2].bvh;
    Random random(seed + 100);
    for (int i = 0; i < 2000; ++i) {
      Ray ray{family.inside, {}};
      const uint64_t zeros = random.below(3);
      for (int k = 0; k < 3; ++k) ray.direction[k] = static_cast<float>(random.uniform(-1, 1));
      for (uint64_t k = 0; k < zeros; ++k) ray.direction[static_cast<int>(random.below(3))] = 0;
      ASSERT_TRUE(!is_valid(ray) || occluded(bvh, family.mesh, ray)) << i;
    }
  });
}

// Does the line touch the triangle's edge exactly? Turned by two corners, each weight is reported once as u.
bool touches_an_edge(const TriangleMesh& mesh, size_t i, const Ray& ray) {
  for (int k = 0; k < 3; ++k) {
    Hit hit;
    const bool is_met =
        intersect_triangle(ray, mesh.vertex(i, k), mesh.vertex(i, (k + 1) % 3), mesh.vertex(i, (k + 2) % 3), hit);
    if (is_met && hit.u == 0) return true;
  }
  return false;
}

// A line that touches no edge leaves a closed mesh as often as it enters.
TEST(Watertight, LinesCrossAnEvenNumberOfTriangles) {
  size_t lines = 0, crossings = 0;
  for_closed_meshes(2, [&](const NamedMesh& family, uint64_t seed) {
    const TriangleMesh& mesh = family.mesh;
    for (Ray ray : test::aimed_rays(mesh, 400, seed + 30)) {
      if (!is_valid(ray)) continue;
      ray.tmin = -kInf;
      ray.tmax = kInf;
      size_t count = 0;
      bool touches = false;
      for (size_t i = 0; i < mesh.triangle_count() && !touches; ++i) {
        Hit hit;
        if (!intersect_triangle(ray, mesh.vertex(i, 0), mesh.vertex(i, 1), mesh.vertex(i, 2), hit)) continue;
        ++count;
        touches = touches_an_edge(mesh, i, ray);
      }
      if (touches) continue;
      ASSERT_EQ(count % 2, 0u);
      ++lines;
      crossings += count;
    }
  });
  EXPECT_GT(lines, test::seed_count(2) * 1500);
  EXPECT_GT(crossings, lines);
}

}  // namespace
}  // namespace raygrain
