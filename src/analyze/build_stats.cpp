#include <algorithm>

#include "raygrain/analyze.h"

namespace raygrain {

BuildStats analyze_build(const Bvh& bvh, const BuildLog& log) {
  BuildStats stats;
  stats.times = log.times;
  const auto inner =
      std::count_if(bvh.nodes.begin(), bvh.nodes.end(), [](const Bvh::Node& node) { return !node.is_leaf(); });
  if (inner == 0) return stats;
  size_t tried = 0, forced = 0;
  for (const NodeLog& node : log.nodes) {
    tried += node.orientations;
    forced += node.forced ? 1 : 0;
  }
  stats.orientations_per_node = static_cast<double>(tried) / static_cast<double>(inner);
  stats.fallback_share = static_cast<double>(forced) / static_cast<double>(inner);
  return stats;
}

}  // namespace raygrain
