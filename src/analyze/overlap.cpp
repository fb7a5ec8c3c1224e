#include "raygrain/analyze.h"

#include "analyze/node_facts.h"

namespace raygrain {
namespace {

using LevelSums = std::array<SiblingOverlap, kOverlapLevels.size()>;

void add(LevelSums& sums, uint32_t level, const SiblingOverlap& overlap) {
  for (size_t i = 0; i < kOverlapLevels.size(); ++i) {
    const bool is_last = i + 1 == kOverlapLevels.size();  // "100" stands for all levels, deeper ones too
    if (level > kOverlapLevels[i] && !is_last) continue;
    sums[i].common += overlap.common;
    sums[i].smaller += overlap.smaller;
  }
}

void set_ratios(std::array<double, kOverlapLevels.size()>& ratios, const LevelSums& sums) {
  for (size_t i = 0; i < sums.size(); ++i) ratios[i] = sums[i].smaller > 0 ? sums[i].common / sums[i].smaller : 0;
}

}  // namespace

OverlapStats analyze_overlap(const Bvh& bvh, const AreaGeometry& area) {
  const std::vector<uint32_t> levels = node_levels(bvh);
  LevelSums plain{}, culled{};
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    const Bvh::Node& node = bvh.nodes[i];
    if (node.is_leaf()) continue;
    const Bounds& left = bvh.nodes[node.first].bounds;
    const Bounds& right = bvh.nodes[node.first + 1].bounds;
    add(plain, levels[i], sibling_overlap(area, left, right, Culling::kNone));
    add(culled, levels[i], sibling_overlap(area, left, right, Culling::kWindow));
  }
  OverlapStats stats;
  set_ratios(stats.plain, plain);
  set_ratios(stats.culled, culled);
  return stats;
}

}  // namespace raygrain
