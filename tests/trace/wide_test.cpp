// Wide trees on every instruction set against brute force, bit for bit.
#include "raygrain/wide.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>

#include <gtest/gtest.h>

#include "raygrain/build.h"
#include "raygrain/error.h"

#include "base/parallel.h"
#include "support/mesh_families.h"
#include "support/same_bits.h"
#include "trace/hand_made_trees.h"

namespace raygrain {
namespace {

using test::same_bits;

std::vector<WideBvh> on_every_isa(const Bvh& tree, const TriangleMesh& mesh, WideOptions options = {}) {
  std::vector<WideBvh> trees;
  for (const Isa isa : supported_isas()) {
    options.isa = isa;
    trees.emplace_back(tree, mesh, options);
  }
  return trees;
}

Bvh binned_tree(const TriangleMesh& mesh) {
  BuildOptions options;
  options.merge_leaves = true;
  return build_binned(triangle_bounds(mesh), triangle_centroids(mesh), options);
}

template <class Body>
void for_families(uint64_t seeds, const Body& body) {
  for (uint64_t seed = 0; seed < test::seed_count(seeds); ++seed)
    for (const test::NamedMesh& family : test::mesh_families(seed)) {
      SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
      body(family.mesh, seed);
      if (testing::Test::HasFatalFailure()) return;
    }
}

/// The first ray of a part about which a tree and the oracle disagree, as text; empty without one.
std::string disagreement(const WideBvh& tree, std::span<const Ray> rays, std::span<const Hit> expected) {
  std::vector<Hit> found(rays.size());
  std::vector<uint8_t> flags(rays.size());
  tree.intersect(rays, found);
  tree.occluded(rays, flags);
  for (size_t i = 0; i < rays.size(); ++i) {
    const bool is_right = same_bits(found[i], expected[i]) && same_bits(tree.intersect(rays[i]), expected[i]) &&
                          (flags[i] != 0) == is_hit(expected[i]) && tree.occluded(rays[i]) == is_hit(expected[i]);
    if (!is_right) return std::string(name(tree.isa())) + ", ray " + std::to_string(i);
  }
  return {};
}

/// The family that brute force needs most time for by far: nearly every triangle takes exact arithmetic.
TriangleMesh slow_mesh(uint64_t seed) {
  for (const test::NamedMesh& family : test::mesh_families(seed))
    if (family.name == "mixed_exponents") return family.mesh;
  return {};
}

// At full scale 10 million rays, each on every instruction set: closest and any hit, over arrays and one by one.
TEST(Wide, AgreesWithTheOracleOnEveryInstructionSet) {
  const bool is_full = test::seed_count(1) > 1;
  std::atomic<size_t> hits = 0;
  size_t all_rays = 0;
  for_families(3, [&](const TriangleMesh& mesh, uint64_t seed) {
    const std::vector<WideBvh> trees = on_every_isa(binned_tree(mesh), mesh);
    const bool is_slow = mesh.vertices == slow_mesh(seed).vertices;
    const std::vector<Ray> rays = test::aimed_rays(mesh, is_full ? (is_slow ? 1400 : 14200) : 400, seed);
    all_rays += rays.size();
    std::mutex lock;
    std::string wrong;
    parallel_for(rays.size(), 200, 0, [&](size_t begin, size_t end) {
      const std::span<const Ray> part(rays.data() + begin, end - begin);
      std::vector<Hit> expected;
      for (const Ray& ray : part) expected.push_back(intersect_reference(mesh, ray));
      hits += static_cast<size_t>(std::ranges::count_if(expected, is_hit));
      for (const WideBvh& tree : trees)
        if (const std::string text = disagreement(tree, part, expected); !text.empty()) {
          const std::lock_guard guard(lock);
          wrong = text + " from " + std::to_string(begin);
        }
    });
    ASSERT_EQ(wrong, "");
  });
  EXPECT_GT(hits, all_rays / 3);
  RecordProperty("rays", std::to_string(all_rays));
  std::printf("%zu rays on %zu instruction sets\n", all_rays, supported_isas().size());
}

TEST(Wide, CountingAndFullTraversalGiveTheSameAnswers) {
  for_families(2, [&](const TriangleMesh& mesh, uint64_t seed) {
    const Bvh binary = binned_tree(mesh);
    const std::vector<WideBvh> trees = on_every_isa(binary, mesh);
    for (const Ray& ray : test::aimed_rays(mesh, 200, seed + 20)) {
      const Hit expected = intersect_reference(mesh, ray);
      for (const WideBvh& tree : trees)
        for (const bool prune : {true, false}) {
          SCOPED_TRACE(std::string(name(tree.isa())) + (prune ? "" : ", all"));
          TraceCounters nearest, any;
          ASSERT_TRUE(same_bits(tree.intersect_counted(ray, nearest, {}, {.prune = prune}), expected));
          ASSERT_TRUE(same_bits(tree.intersect(ray, {}, {.prune = prune}), expected));
          ASSERT_EQ(tree.occluded_counted(ray, any, {.prune = prune}), is_hit(expected));
          ASSERT_EQ(tree.occluded(ray, {.prune = prune}), is_hit(expected));
          for (const TraceCounters& c : {nearest, any}) {
            ASSERT_LE(c.inner_hits, tree.node_count());
            ASSERT_LE(c.leaf_hits, tree.leaf_count());
            ASSERT_LE(c.triangle_tests, c.leaf_triangles);
            ASSERT_LE(c.leaf_triangles, 8 * c.leaf_hits);
            ASSERT_LE(c.inner_hits + c.leaf_hits, c.box_tests + 1);
          }
          ASSERT_TRUE(!is_hit(expected) || nearest.triangle_tests > 0);
        }
    }
  });
}

TEST(Wide, TakesAnyBinaryTreeAndAnyLeafSize) {
  for_families(2, [&](const TriangleMesh& mesh, uint64_t seed) {
    std::vector<test::NamedTree> binaries = test::hand_made_trees(mesh);
    const std::vector<Ray> rays = test::aimed_rays(mesh, 60, seed + 40);
    for (const auto& [tree_name, binary] : binaries)
      for (const uint32_t leaf_size : {1u, 3u, 8u}) {
        SCOPED_TRACE(tree_name + ", leaves of " + std::to_string(leaf_size));
        for (const WideBvh& tree : on_every_isa(binary, mesh, {.max_leaf_size = leaf_size})) {
          ASSERT_GE(tree.leaf_count() * leaf_size, mesh.triangle_count());
          for (const Ray& ray : rays) {
            const Hit expected = intersect_reference(mesh, ray);
            ASSERT_TRUE(same_bits(tree.intersect(ray), expected)) << name(tree.isa());
            ASSERT_EQ(tree.occluded(ray), is_hit(expected)) << name(tree.isa());
          }
        }
      }
  });
}

// A search over half of the triangles, given the best of the other half.
TEST(Wide, MergesWithWhatIsKnown) {
  for_families(2, [&](const TriangleMesh& mesh, uint64_t seed) {
    std::vector<uint32_t> odd, even;
    for (const uint32_t id : test::all_triangles(mesh)) (id % 2 ? odd : even).push_back(id);
    const auto halves = [](uint32_t count, uint32_t) { return count > 3 ? count / 2 : 0; };
    const std::vector<WideBvh> odd_trees = on_every_isa(test::split_tree(mesh, odd, halves), mesh);
    const std::vector<WideBvh> even_trees = on_every_isa(test::split_tree(mesh, even, halves), mesh);
    for (const Ray& ray : test::aimed_rays(mesh, 200, seed + 50)) {
      const Hit expected = intersect_reference(mesh, ray);
      for (size_t i = 0; i < odd_trees.size(); ++i) {
        ASSERT_TRUE(same_bits(even_trees[i].intersect(ray, odd_trees[i].intersect(ray)), expected));
        ASSERT_TRUE(same_bits(odd_trees[i].intersect(ray, even_trees[i].intersect(ray)), expected));
        ASSERT_TRUE(same_bits(odd_trees[i].intersect(ray, expected), expected));
      }
    }
  });
}

TEST(Wide, SkipsOnlyBoxesThatTheRayHasLeft) {
  uint64_t boxes = 0, all_boxes = 0;
  for_families(2, [&](const TriangleMesh& mesh, uint64_t seed) {
    const std::vector<WideBvh> trees = on_every_isa(test::hand_made_trees(mesh)[1].bvh, mesh, {.max_leaf_size = 1});
    for (Ray ray : test::aimed_rays(mesh, 100, seed + 70)) {
      ray.tmin = -kInf;
      const Hit expected = intersect_reference(mesh, ray);
      for (const float skip : {expected.t, std::nextafter(expected.t, kInf), 0.0f, 0.5f, 1.0f, kInf}) {
        Ray rest = ray;
        rest.tmin = skip;
        const Hit beyond = intersect_reference(mesh, rest);
        for (const WideBvh& tree : trees) {
          ASSERT_TRUE(same_bits(tree.intersect(rest, {}, {.skip_before = skip}), beyond));
          TraceCounters counters;
          const Hit found = tree.intersect_counted(ray, counters, {}, {.skip_before = skip, .prune = false});
          ASSERT_FALSE(is_nearer(beyond, found));
          ASSERT_FALSE(is_nearer(found, expected));
          ASSERT_TRUE(tree.occluded(ray, {.skip_before = skip}) || !is_hit(beyond));
          boxes += counters.inner_hits + counters.leaf_hits;
          counters = {};
          tree.intersect_counted(ray, counters, {}, {.prune = false});
          all_boxes += counters.inner_hits + counters.leaf_hits;
        }
      }
    }
  });
  EXPECT_LT(boxes, all_boxes * 3 / 4);
}

TEST(Wide, ArraysDoNotDependOnThreads) {
  const TriangleMesh mesh = test::mesh_families(3).front().mesh;
  const Bvh binary = binned_tree(mesh);
  const std::vector<Ray> rays = test::aimed_rays(mesh, 20000, 5);
  for (const WideBvh& tree : on_every_isa(binary, mesh)) {
    std::vector<Hit> hits(rays.size());
    std::vector<uint8_t> flags(rays.size());
    tree.intersect(rays, hits);
    tree.occluded(rays, flags);
    for (const unsigned threads : {0u, 2u, 8u}) {
      std::vector<Hit> again(rays.size());
      std::vector<uint8_t> flags_again(rays.size(), 7);
      tree.intersect(rays, again, threads);
      tree.occluded(rays, flags_again, threads);
      EXPECT_EQ(hits, again);
      EXPECT_EQ(flags, flags_again);
    }
  }
}

TEST(Wide, EmptyTreesAndInvalidRaysReturnWhatIsKnown) {
  const test::NamedMesh box = test::mesh_families(1).front();
  const Hit known{3, 0.25f, 0.5f, 7};
  const Ray good{{0, 0, 0}, {1, 0.25f, 0.125f}};
  for (const WideBvh& empty : {WideBvh(), WideBvh(Bvh{}, {})}) {
    EXPECT_EQ(empty.intersect(good, known), known);
    EXPECT_FALSE(empty.occluded(good));
    EXPECT_EQ(empty.node_count(), 0u);
    EXPECT_EQ(empty.memory_bytes(), 0u);
    std::vector<Hit> hits(1, known);
    std::vector<uint8_t> flags(1, 7);
    empty.intersect(std::span(&good, 1), hits);
    empty.occluded(std::span(&good, 1), flags);
    EXPECT_EQ(hits[0], Hit{});
    EXPECT_EQ(flags[0], 0);
  }
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Ray> bad_rays = {{{nan, 0, 0}, {1, 0, 0}},       {{0, 0, 0}, {1, nan, 0}},
                                     {{0, kInf, 0}, {1, 0, 0}},      {{0, 0, 0}, {1, -kInf, 0}},
                                     {{0, 0, 0}, {0, 0, 0}},         {{0, 0, 0}, {1, 0, 0}, nan, 1},
                                     {{0, 0, 0}, {1, 0, 0}, 0, nan}, {{0, 0, 0}, {1, 0, 0}, 2, 0}};
  for (const WideBvh& tree : on_every_isa(binned_tree(box.mesh), box.mesh)) {
    EXPECT_TRUE(tree.occluded(good));
    std::vector<Hit> hits(bad_rays.size(), known);
    std::vector<uint8_t> flags(bad_rays.size(), 7);
    tree.intersect(bad_rays, hits);
    tree.occluded(bad_rays, flags);
    for (size_t i = 0; i < bad_rays.size(); ++i) {
      TraceCounters counters;
      EXPECT_EQ(tree.intersect_counted(bad_rays[i], counters, known), known);
      EXPECT_EQ(tree.intersect(bad_rays[i], known), known);
      EXPECT_FALSE(tree.occluded_counted(bad_rays[i], counters));
      EXPECT_FALSE(tree.occluded(bad_rays[i]));
      EXPECT_EQ(counters, TraceCounters{});
      EXPECT_EQ(hits[i], Hit{});
      EXPECT_EQ(flags[i], 0);
    }
  }
}

TEST(Wide, TheDeepestTreeFitsTheStack) {
  TriangleMesh mesh;
  for (uint32_t i = 0; i < 2000; ++i) {
    const auto x = static_cast<float>(i);
    mesh.vertices.insert(mesh.vertices.end(), {{x, -1, -1}, {x, 2, -1}, {x, -1, 2}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const auto ids = test::all_triangles(mesh);
  for (const auto rule : {+[](uint32_t count, uint32_t) { return count - 1; }, +[](uint32_t, uint32_t) { return 1u; }})
    for (const WideBvh& tree : on_every_isa(test::split_tree(mesh, ids, rule), mesh, {.max_leaf_size = 1})) {
      EXPECT_EQ(tree.intersect({{-1, 0, 0}, {1, 0, 0}}).triangle, 0u);
      EXPECT_EQ(tree.intersect({{2100, 0, 0}, {-1, 0, 0}}).triangle, 1999u);
      EXPECT_EQ(tree.intersect({{150.5f, 0, 0}, {1, 0, 0}}, {}, {.prune = false}).triangle, 151u);
      EXPECT_TRUE(tree.occluded({{150.5f, 0, 0}, {1, 0, 0}}, {.prune = false}));
    }
}

// More candidates than a search keeps must not end a search that is to visit everything.
TEST(Wide, FullTraversalVisitsAllOfManyCandidates) {
  TriangleMesh mesh;
  for (uint32_t i = 0; i < 60; ++i) {
    const auto x = static_cast<float>(i);
    mesh.vertices.insert(mesh.vertices.end(), {{x, -1, -1}, {x, 2, -1}, {x, -1, 2}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  for (const WideBvh& tree : on_every_isa(binned_tree(mesh), mesh, {.max_leaf_size = 1})) {
    TraceCounters all, pruned;
    EXPECT_EQ(tree.intersect_counted({{-1, 0, 0}, {1, 0, 0}}, all, {}, {.prune = false}).triangle, 0u);
    EXPECT_EQ(tree.intersect_counted({{-1, 0, 0}, {1, 0, 0}}, pruned).triangle, 0u);
    EXPECT_EQ(all.leaf_hits, 60u) << name(tree.isa());
    EXPECT_LT(pruned.leaf_hits, 5u) << name(tree.isa());
  }
}

}  // namespace
}  // namespace raygrain
