// Leaves that are long along the rays: what lies behind a sure hit in the same leaf is not decided.
#include <gtest/gtest.h>

#include "raygrain/wide.h"

#include "base/random.h"
#include "trace/hand_made_trees.h"

namespace raygrain {
namespace {

/// `count` walls across the x axis, all of them in one leaf. Distances from x = 10 lie half way between two floats
/// often.
TriangleMesh walls(uint32_t count, Random& random) {
  TriangleMesh mesh;
  for (uint32_t i = 0; i < count; ++i) {
    const auto x = static_cast<float>(-1.0 - i - random.uniform(0, 0.5));
    mesh.vertices.insert(mesh.vertices.end(), {{x, -9, -9}, {x, 9, -9}, {x, 0, 9}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

WideBvh one_leaf(const TriangleMesh& mesh, Isa isa) {
  return {test::split_tree(mesh, test::all_triangles(mesh), [](uint32_t, uint32_t) { return 0u; }), mesh, {.isa = isa}};
}

TEST(WideLayers, OnlyTheFirstOfALeafIsDecided) {
  Random random(1);
  const TriangleMesh mesh = walls(8, random);
  for (const Isa isa : supported_isas()) {
    const WideBvh tree = one_leaf(mesh, isa);
    ASSERT_EQ(tree.leaf_count(), 1u);
    TraceCounters pruned, full;
    tree.intersect_counted({{10, 0, 0}, {-1, 0, 0}}, pruned);
    tree.intersect_counted({{10, 0, 0}, {-1, 0, 0}}, full, {}, {.prune = false});
    EXPECT_EQ(pruned.triangle_tests, 1u) << name(isa);
    EXPECT_EQ(full.triangle_tests, 8u) << name(isa);
  }
}

TEST(WideLayers, AnswersAreTheOracles) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    TriangleMesh mesh = walls(8, random);
    for (size_t i = 0; i < 3; ++i) mesh.vertices[3 + i] = mesh.vertices[i];  // the lesser id of equal ones wins
    std::vector<Ray> rays;
    for (int i = 0; i < 200; ++i) {
      const auto y = static_cast<float>(random.uniform(-8, 8)), z = static_cast<float>(random.uniform(-8, 8));
      const auto slope = static_cast<float>(i % 4 == 0 ? random.uniform(-0.2, 0.2) : 0);
      rays.push_back({{i % 2 == 0 ? 10.0f : -30.0f, y, z}, {i % 2 == 0 ? -1.0f : 1.0f, slope, 0}});
    }
    for (const Isa isa : supported_isas()) {
      const WideBvh tree = one_leaf(mesh, isa);
      std::vector<Hit> hits(rays.size());
      tree.intersect(rays, hits);
      for (size_t i = 0; i < rays.size(); ++i) {
        const Hit expected = intersect_reference(mesh, rays[i]);
        ASSERT_EQ(hits[i], expected) << name(isa) << ", seed " << seed << ", ray " << i;
        ASSERT_EQ(tree.intersect(rays[i]), expected) << name(isa) << ", seed " << seed << ", ray " << i;
      }
    }
  }
}

}  // namespace
}  // namespace raygrain
