#include <algorithm>

#include "raygrain/analyze.h"

#include "analyze/node_facts.h"
#include "build/estimate.h"

namespace raygrain {
namespace {

void add_leaf(TreeStats& stats, const Bvh::Node& leaf, uint32_t level) {
  ++stats.leaves;
  stats.triangles += leaf.count;
  stats.max_triangles_per_leaf = std::max<size_t>(stats.max_triangles_per_leaf, leaf.count);
  stats.max_level = std::max(stats.max_level, level);
  stats.mean_leaf_depth += static_cast<double>(level);  // a sum until the end
}

/// Mean measure of smaller and larger child per parent, over the inner nodes that have any.
void set_child_ratios(TreeStats& stats, const Bvh& bvh, std::span<const float> measures) {
  double small = 0, large = 0;
  size_t nodes = 0;
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    const Bvh::Node& node = bvh.nodes[i];
    if (node.is_leaf() || !(measures[i] > 0)) continue;
    const auto [smaller, larger] = std::minmax(measures[node.first], measures[node.first + 1]);
    small += static_cast<double>(conditional_probability(smaller, measures[i]));
    large += static_cast<double>(conditional_probability(larger, measures[i]));
    ++nodes;
  }
  if (nodes == 0) return;
  stats.small_child_ratio = small / static_cast<double>(nodes);
  stats.large_child_ratio = large / static_cast<double>(nodes);
}

}  // namespace

TreeStats analyze(const Bvh& bvh, const RayMeasure& measure, const CostModel& costs) {
  TreeStats stats;
  stats.memory_bytes = memory_bytes(bvh);
  if (bvh.nodes.empty()) return stats;
  const std::vector<uint32_t> levels = node_levels(bvh);
  const std::vector<float> measures = node_measures(bvh, measure);
  for (size_t i = 0; i < bvh.nodes.size(); ++i)
    if (bvh.nodes[i].is_leaf()) add_leaf(stats, bvh.nodes[i], levels[i]);
  stats.estimated_cost = estimated_cost(bvh, measure, costs);
  stats.nodes = bvh.nodes.size();
  stats.triangles_per_leaf = static_cast<double>(stats.triangles) / static_cast<double>(stats.leaves);
  stats.mean_leaf_depth /= static_cast<double>(stats.leaves);
  stats.paper_memory_bytes = paper_memory_bytes(stats.nodes, stats.triangles);
  set_child_ratios(stats, bvh, measures);
  return stats;
}

}  // namespace raygrain
