// build_binned against a slow search over the same planes; merging of leaves by the cost model.
#include <algorithm>
#include <limits>

#include "raygrain/error.h"

#include "build/build_support.h"
#include "support/mesh_families.h"

namespace raygrain::test {
namespace {

/// Least cost over all axes and slices of the centroids' box, or between any two centroids of up to eight primitives,
/// each priced by a repartition.
double slow_least_cost(const Prims& prims, const std::vector<uint32_t>& ids, uint32_t bins) {
  const RayMeasure measure;
  Bounds centroids;
  for (const uint32_t id : ids) centroids.extend(prims.centroids[id]);
  double least = std::numeric_limits<double>::infinity();
  const uint32_t slices = std::min(bins, 4 + static_cast<uint32_t>(ids.size()) / 16);
  const bool small = ids.size() <= 8;
  for (int axis = 0; axis < 3; ++axis)
    for (uint32_t i = small ? 0 : 1; i < (small ? ids.size() : slices); ++i) {
      const float lo = centroids.lo[axis], length = centroids.hi[axis] - lo;
      const float scale = static_cast<float>(slices) * (1 - 0x1p-20f) / length;
      Bounds left, right;
      double left_count = 0, right_count = 0;
      for (const uint32_t id : ids) {
        const float key = prims.centroids[id][axis];
        const bool is_left = small ? key < prims.centroids[ids[i]][axis] : (key - lo) * scale < static_cast<float>(i);
        (is_left ? left : right).extend(prims.bounds[id]);
        (is_left ? left_count : right_count) += 1;
      }
      if (left_count == 0 || right_count == 0) continue;
      least = std::min(
          least, static_cast<double>(measure(left)) * left_count + static_cast<double>(measure(right)) * right_count);
    }
  return least;
}

std::vector<uint32_t> ids_below(const Bvh& bvh, uint32_t node) {
  if (bvh.nodes[node].is_leaf()) {
    const auto first = bvh.prims.begin() + bvh.nodes[node].first;
    return {first, first + bvh.nodes[node].count};
  }
  std::vector<uint32_t> ids = ids_below(bvh, bvh.nodes[node].first);
  const std::vector<uint32_t> right = ids_below(bvh, bvh.nodes[node].first + 1);
  ids.insert(ids.end(), right.begin(), right.end());
  return ids;
}

/// Every split of the tree is the cheapest of its node.
void expect_cheapest_splits(const Prims& prims, uint32_t bins) {
  BuildOptions options;
  options.parameters.bins = bins;
  const Bvh bvh = binned(prims, options);
  const RayMeasure measure;
  for (uint32_t i = 0; i < bvh.nodes.size(); ++i) {
    if (bvh.nodes[i].is_leaf()) continue;
    const double least = slow_least_cost(prims, ids_below(bvh, i), bins);
    if (least == std::numeric_limits<double>::infinity()) continue;  // inseparable
    double cost = 0;
    for (uint32_t child = bvh.nodes[i].first; child < bvh.nodes[i].first + 2; ++child)
      cost += static_cast<double>(measure(bvh.nodes[child].bounds)) * static_cast<double>(ids_below(bvh, child).size());
    EXPECT_EQ(cost, least) << "node " << i;
  }
}

TEST(Binned, EverySplitIsTheCheapestOnRandomTriangles) {
  for (uint64_t seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(seed);
    expect_cheapest_splits(random_prims(30 + 20 * seed, seed), seed % 2 ? 40 : 9);
  }
}

TEST(Binned, EverySplitIsTheCheapestOnAllMeshFamilies) {
  for (const NamedMesh& mesh : mesh_families(5)) {
    SCOPED_TRACE(mesh.name);
    expect_cheapest_splits(prims_of(mesh.mesh), 16);
  }
}

TEST(Binned, RareNodesAreNotSplit) {
  const Prims prims = random_prims(2000, 7);
  BuildOptions options;
  const Bvh whole = binned(prims, options);
  options.rare_leaf_size = 8;
  for (const float share : {0.0f, 20.0f, 1e9f}) {
    options.rare_share = share;
    const Bvh bvh = binned(prims, options);
    EXPECT_EQ(find_defect(bvh, prims.bounds), std::nullopt);
    const RayMeasure measure;
    const float limit = share / 2000 * measure(bvh.nodes[0].bounds);
    for (const Bvh::Node& node : bvh.nodes) {
      const bool is_rare = measure(node.bounds) < limit;
      if (node.is_leaf()) {
        EXPECT_LE(node.count, is_rare ? 8u : 1u);
      } else {  // no inner node that should have been a leaf
        EXPECT_FALSE(is_rare && bvh.nodes[node.first].count + bvh.nodes[node.first + 1].count <= 8 &&
                     bvh.nodes[node.first].is_leaf() && bvh.nodes[node.first + 1].is_leaf());
      }
    }
    EXPECT_EQ(bvh.nodes.size() < whole.nodes.size(), share > 0);
  }
  options.rare_share = -1;
  EXPECT_THROW(binned(prims, options), Error);
}

TEST(Binned, AdmitsAxesByQuality) {
  const Prims prims = random_prims(200, 2);
  BuildOptions options;
  options.strategy.orientation = fixed_axes({{1, 0.3f}, {0, 0.2f}, {2, 0.1f}});
  const auto axes = [&](float threshold) {
    options.parameters.split_plane_quality_threshold = threshold;
    BuildLog log;
    binned(prims, options, &log);
    return log.nodes[0].orientations;
  };
  EXPECT_EQ(axes(0), 3);
  EXPECT_EQ(axes(0.15f), 2);
  EXPECT_EQ(axes(0.25f), 1);
  EXPECT_EQ(axes(0.9f), 1);  // the best, when none is good enough
}

TEST(Binned, MergesLeavesWhereSplittingCostsMore) {
  // Two boxes in the same place: as a leaf 1.2 * 2 = 2.4, split 2 + 1.2 * 2 = 4.4.
  Prims together = cubes({{0, 0, 0}, {0.1f, 0, 0}});
  BuildOptions options;
  EXPECT_EQ(binned(together, options).nodes.size(), 3u);
  options.merge_leaves = true;
  EXPECT_EQ(binned(together, options).nodes.size(), 1u);
  // Free inner nodes: splitting pays again, as 2.1 of 2.2 lengths are met by one box only.
  options.costs.inner = 0;
  EXPECT_EQ(binned(together, options).nodes.size(), 3u);
  options.costs.inner = 2;
  // More than leaf_size primitives are split whatever it costs.
  options.leaf_size = 1;
  EXPECT_EQ(binned(together, options).nodes.size(), 3u);
}

TEST(Binned, MergingLowersTheEstimatedCost) {
  const auto estimate = [](const Bvh& bvh, const CostModel& costs) {
    const RayMeasure measure;
    double sum = 0;
    for (const Bvh::Node& node : bvh.nodes)
      sum += static_cast<double>(measure(node.bounds)) *
             static_cast<double>(node.is_leaf() ? costs.triangle * static_cast<float>(node.count) : costs.inner);
    return sum;
  };
  for (uint64_t seed = 0; seed < 5; ++seed) {
    SCOPED_TRACE(seed);
    const Prims prims = random_prims(500, seed);
    BuildOptions options;
    const Bvh split = binned(prims, options);
    options.merge_leaves = true;
    options.leaf_size = 8;
    const Bvh merged = binned(prims, options);
    EXPECT_EQ(find_defect(merged, prims.bounds), std::nullopt);
    EXPECT_LT(merged.nodes.size(), split.nodes.size());
    EXPECT_LE(largest_leaf(merged), 8u);
    EXPECT_LT(estimate(merged, options.costs), estimate(split, options.costs));
  }
}

}  // namespace
}  // namespace raygrain::test
