// The parallel builders: the same tree, byte for byte, for any number of threads; progress and cancellation.
#include <cstring>

#include "raygrain/error.h"

#include "build/build_support.h"
#include "build/estimate.h"
#include "support/mesh_families.h"

namespace raygrain::test {
namespace {

template <class Item>
bool same_bytes(const std::vector<Item>& a, const std::vector<Item>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Item)) == 0);
}

bool identical(const Bvh& a, const Bvh& b) {
  return same_bytes(a.nodes, b.nodes) && same_bytes(a.prims, b.prims) && a.split_references == b.split_references;
}

void expect_same_for_all_threads(const Prims& prims, BuildOptions options) {
  options.threads = 1;
  BuildLog log;
  const Bvh one = binned(prims, options, &log);
  EXPECT_EQ(find_defect(one, prims.bounds), std::nullopt);
  EXPECT_GE(log.peak_bytes, memory_bytes(one));
  for (const unsigned threads : {2u, 8u, 0u}) {
    options.threads = threads;
    BuildLog other;
    EXPECT_TRUE(identical(one, binned(prims, options, &other))) << threads << " threads";
    ASSERT_EQ(log.nodes.size(), other.nodes.size());
    for (size_t i = 0; i < log.nodes.size(); ++i) EXPECT_EQ(log.nodes[i].ratio, other.nodes[i].ratio);
  }
}

TEST(ParallelBuild, GivesTheSameTreeForAnyNumberOfThreads) {
  for (uint64_t seed = 0; seed < seed_count(4); ++seed) {
    SCOPED_TRACE(seed);
    BuildOptions options;
    options.merge_leaves = seed % 2 == 0;
    options.seed = seed;
    // The orientation sees the node's seed: that too must not depend on threads.
    if (seed % 2)
      options.strategy.orientation = [](const NodeContext& node) {
        AxisOrder order;
        order.push({static_cast<int>(node.seed % 3), 1});
        return order;
      };
    expect_same_for_all_threads(random_prims(70000 + 1000 * static_cast<uint32_t>(seed), seed), options);
  }
}

TEST(ParallelBuild, GivesTheSameTreeWherePrimitivesCoincide) {
  Prims prims;
  for (int i = 0; i < 50000; ++i) prims.add({{1, 2, 3}, {2, 3, 4}}, {i < 20000 ? 0.0f : -0.0f, 0, 0});
  expect_same_for_all_threads(prims, {});
}

TEST(ParallelBuild, LargeLeavesAreKeptWhole) {
  Prims prims;
  for (int i = 0; i < 40000; ++i) prims.add({{1, 2, 3}, {2, 3, 4}});
  BuildOptions options;
  options.split_inseparable = false;
  EXPECT_EQ(largest_leaf(binned(prims, options)), 40000u);
}

TEST(ParallelBuild, SmallMeshesAreTheSameToo) {
  for (const NamedMesh& mesh : mesh_families(3)) {
    SCOPED_TRACE(mesh.name);
    expect_same_for_all_threads(prims_of(mesh.mesh), {});
  }
}

TEST(Subset, GivesTheSameTreeForAnyNumberOfThreads) {
  for (uint64_t seed = 0; seed < seed_count(4); ++seed) {
    SCOPED_TRACE(seed);
    const Prims prims = random_prims(30000, seed);
    BuildOptions options;
    options.seed = seed;
    options.threads = 1;
    options.merge_leaves = seed % 2 == 0;
    BuildLog log;
    const Bvh one = build_subset(prims.bounds, prims.centroids, options, &log);
    EXPECT_EQ(find_defect(one, prims.bounds), std::nullopt);
    EXPECT_EQ(log.nodes.size(), one.nodes.size());
    for (size_t i = 0; i < one.nodes.size(); ++i) ASSERT_EQ(one.nodes[i].is_leaf(), log.nodes[i].axis < 0);
    options.threads = 8;
    EXPECT_TRUE(identical(one, build_subset(prims.bounds, prims.centroids, options, nullptr)));
    // Not far from the best, and another subset for another seed.
    EXPECT_LT(estimated_cost(one, {}), 1.2 * estimated_cost(binned(prims, options), {}));
    ++options.seed;
    EXPECT_FALSE(identical(one, build_subset(prims.bounds, prims.centroids, options, nullptr)));
  }
}

TEST(Subset, CopesWithHugePiles) {
  Prims prims;
  for (int i = 0; i < 20000; ++i) prims.add({{1, 2, 3}, {2, 3, 4}});
  const Bvh bvh = build_subset(prims.bounds, prims.centroids, {}, nullptr);
  EXPECT_EQ(find_defect(bvh, prims.bounds), std::nullopt);
  EXPECT_LE(largest_leaf(bvh), 4u);
}

TEST(Progress, RisesToOne) {
  const Prims prims = random_prims(100000, 1);
  for (const auto build : {build_paper, build_binned, build_subset}) {
    BuildOptions options;
    double last = 0;
    size_t calls = 0;
    options.progress = [&](double done) {
      EXPECT_GE(done, last);
      EXPECT_LE(done, 1);
      last = done;
      ++calls;
      return true;
    };
    build(prims.bounds, prims.centroids, options, nullptr);
    EXPECT_EQ(last, 1);
    EXPECT_GT(calls, 5u);
  }
}

TEST(Progress, FalseCancelsTheBuild) {
  const Prims prims = random_prims(60000, 2);
  for (const auto build : {build_paper, build_binned})
    for (const unsigned threads : {1u, 4u})
      for (const double limit : {0.0, 0.3}) {
        BuildOptions options;
        options.threads = threads;
        bool was_told = false;
        options.progress = [&](double done) {
          EXPECT_FALSE(was_told) << "called again after it said no";
          was_told = done >= limit;
          return !was_told;
        };
        try {
          build(prims.bounds, prims.centroids, options, nullptr);
          ADD_FAILURE() << "not cancelled";
        } catch (const Error& error) {
          EXPECT_EQ(error.code, ErrorCode::kCancelled);
        }
      }
}

}  // namespace
}  // namespace raygrain::test
