#include "raygrain/bvh.h"

#include <algorithm>

namespace raygrain {

size_t memory_bytes(const Bvh& bvh) {
  return bvh.nodes.capacity() * sizeof(Bvh::Node) + bvh.prims.capacity() * sizeof(uint32_t);
}

uint32_t max_level(const Bvh& bvh) {
  std::vector<uint32_t> levels(bvh.nodes.size(), 0);
  uint32_t deepest = 0;
  // Children stand after their parent, so one pass in order knows every parent's level in time.
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    deepest = std::max(deepest, levels[i]);
    if (bvh.nodes[i].is_leaf()) continue;
    for (size_t side = 0; side < 2; ++side) {
      const size_t child = size_t{bvh.nodes[i].first} + side;
      if (child > i && child < levels.size()) levels[child] = levels[i] + 1;
    }
  }
  return deepest;
}

}  // namespace raygrain
