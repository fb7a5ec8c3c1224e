// The counters that the cost model is made of.
#include <gtest/gtest.h>

#include "raygrain/trace.h"

#include "base/random.h"
#include "support/mesh_families.h"
#include "trace/hand_made_trees.h"

namespace raygrain {
namespace {

// Walls at x = 1, 2, 3, 4, one leaf each under two inner nodes and a root.
TEST(Counters, OfATreeCountedByHand) {
  TriangleMesh mesh;
  for (uint32_t i = 0; i < 4; ++i) {
    const float x = static_cast<float>(i) + 1;
    mesh.vertices.insert(mesh.vertices.end(), {{x, 0, 0}, {x, 4, 0}, {x, 0, 4}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const Bvh bvh = test::split_tree(mesh, test::all_triangles(mesh), [](uint32_t n, uint32_t) { return n / 2; });
  const auto count = [&](const Ray& ray, bool prune) {
    TraceCounters counters;
    intersect(bvh, mesh, ray, {}, {.prune = prune}, &counters);
    return counters;
  };
  using C = TraceCounters;
  const Ray forward{{0, 1, 1}, {1, 0, 0}};
  EXPECT_EQ(count(forward, false), (C{3, 4, 4, 7, 4}));
  EXPECT_EQ(count(forward, true), (C{2, 1, 1, 5, 1}));
  const Ray beside{{0, 3, 3}, {1, 0, 0}};  // in every box, in no triangle
  EXPECT_EQ(count(beside, true), (C{3, 4, 4, 7, 4}));
  const Ray outside{{0, 5, 3}, {1, 0, 0}};
  EXPECT_EQ(count(outside, false), (C{0, 0, 0, 1, 0}));
  const Ray between{{0, 1, 1}, {1, 0, 0}, 1.5f, 2.5f};  // the interval counts in a full traversal too
  EXPECT_EQ(count(between, false), (C{2, 1, 1, 5, 1}));
  const Ray touching{{0, 1, 1}, {1, 0, 0}, 2, 3};
  EXPECT_EQ(count(touching, false), (C{3, 2, 2, 7, 2}));
  TraceCounters counters;
  EXPECT_TRUE(occluded(bvh, mesh, forward, {}, &counters));
  EXPECT_EQ(counters, (C{2, 1, 1, 5, 1}));
  EXPECT_TRUE(occluded(bvh, mesh, forward, {.prune = false}, &counters));
  EXPECT_EQ(counters, (C{5, 5, 5, 12, 5}));
}

TEST(Counters, AddUp) {
  TraceCounters sum{1, 2, 3, 4, 5};
  sum.add({10, 20, 30, 40, 50});
  EXPECT_EQ(sum, (TraceCounters{11, 22, 33, 44, 55}));
}

// Does the ray o + t d, t >= 0, meet the box? Exactly, in integers: t is a fraction.
bool meets(const int64_t (&o)[3], const int64_t (&d)[3], const Bounds& box) {
  int64_t entry[] = {0, 1}, exit[] = {1, 0};  // numerator, denominator >= 0
  for (int k = 0; k < 3; ++k) {
    const int64_t lo = static_cast<int64_t>(box.lo[k]) - o[k], hi = static_cast<int64_t>(box.hi[k]) - o[k];
    if (d[k] == 0) {
      if (lo > 0 || hi < 0) return false;
      continue;
    }
    const int64_t size = d[k] > 0 ? d[k] : -d[k], near = d[k] > 0 ? lo : -hi, far = d[k] > 0 ? hi : -lo;
    if (near * entry[1] > entry[0] * size) entry[0] = near, entry[1] = size;
    if (far * exit[1] < exit[0] * size) exit[0] = far, exit[1] = size;
  }
  return exit[0] >= 0 && entry[0] * exit[1] <= exit[0] * entry[1];
}

TEST(Counters, FullTraversalCountsExactlyTheBoxesThatTheRayMeets) {
  Random random(3);
  const auto integer = [&] { return static_cast<int64_t>(random.below(17)) - 8; };
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    TriangleMesh mesh;
    for (uint32_t i = 0; i < 120; ++i) {
      const auto x = static_cast<float>(integer()), y = static_cast<float>(integer());
      mesh.vertices.push_back({x, y, static_cast<float>(integer())});
      if (i % 3 == 2) mesh.triangles.push_back({i - 2, i - 1, i});
    }
    for (const auto& [name, bvh] : test::hand_made_trees(mesh))
      for (int i = 0; i < 100; ++i) {
        const int64_t o[] = {integer(), integer(), integer()}, d[] = {integer(), integer(), integer()};
        const Ray ray{to_float({double(o[0]), double(o[1]), double(o[2])}),
                      to_float({double(d[0]), double(d[1]), double(d[2])})};
        if (!is_valid(ray)) continue;
        TraceCounters expected, counters;
        for (const Bvh::Node& node : bvh.nodes) {  // boxes are nested, so a box that is met has parents that are met
          if (!meets(o, d, node.bounds)) continue;
          (node.is_leaf() ? expected.leaf_hits : expected.inner_hits) += 1;
          expected.leaf_triangles += node.count;
        }
        expected.box_tests = 1 + 2 * expected.inner_hits;
        expected.triangle_tests = expected.leaf_triangles;
        intersect(bvh, mesh, ray, {}, {.prune = false}, &counters);
        ASSERT_EQ(counters, expected) << name;
      }
  }
}

TEST(Counters, PrunedSearchesCostNoMoreAndAnswersDoNotDependOnCounting) {
  for (const test::NamedMesh& family : test::mesh_families(4)) {
    SCOPED_TRACE(family.name);
    for (const auto& [name, bvh] : test::hand_made_trees(family.mesh))
      for (const Ray& ray : test::aimed_rays(family.mesh, 60, 4)) {
        TraceCounters full, pruned, any;
        const Hit hit = intersect(bvh, family.mesh, ray, {}, {.prune = false}, &full);
        ASSERT_EQ(intersect(bvh, family.mesh, ray, {}, {}, &pruned), hit);
        ASSERT_EQ(intersect(bvh, family.mesh, ray), hit);
        ASSERT_EQ(occluded(bvh, family.mesh, ray, {}, &any), is_hit(hit));
        for (const TraceCounters& part : {pruned, any}) {
          ASSERT_LE(part.inner_hits, full.inner_hits);
          ASSERT_LE(part.leaf_hits, full.leaf_hits);
          ASSERT_LE(part.leaf_triangles, full.leaf_triangles);
          ASSERT_LE(part.box_tests, full.box_tests);
          ASSERT_LE(part.triangle_tests, full.triangle_tests);
        }
        ASSERT_TRUE(is_hit(hit) || pruned == full);
      }
  }
}

}  // namespace
}  // namespace raygrain
