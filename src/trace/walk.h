// The one loop over a binary tree that every search shares: near child first, iterative, on a bounded stack.
#pragma once

#include <array>
#include <cmath>

#include "raygrain/trace.h"

#include "base/check.h"
#include "trace/slabs.h"

namespace raygrain {

/// The parameters that still matter. A hit reports t rounded to float, so its true t may lie beyond a float limit by
/// less than the distance to the next float: the limits stand there.
struct Range {
  double earliest, latest;

  static double below(float t) { return std::nextafter(t, -kInf); }
  static double above(float t) { return std::nextafter(t, kInf); }

  bool meets(const Interval& inside) const {
    return inside.entry <= inside.exit && inside.entry <= latest && inside.exit >= earliest;
  }
};

/// Calls leaf(node) for every leaf whose box the ray meets within `range`, until it returns false. `leaf` may lower
/// range.latest on the way.
template <bool kCounting, class Leaf>
void walk(const Bvh& bvh, const Slabs& slabs, const Range& range, TraceCounters* counters, const Leaf& leaf) {
  struct Pending {
    uint32_t node;
    double entry;
  };
  std::array<Pending, kMaxTreeLevels + 1> stack;
  size_t size = 0;
  uint32_t index = 0;
  if constexpr (kCounting) ++counters->box_tests;
  if (!range.meets(slabs(bvh.nodes[0].bounds))) return;
  while (true) {
    const Bvh::Node& node = bvh.nodes[index];
    if (node.is_leaf()) {
      if constexpr (kCounting) {
        ++counters->leaf_hits;
        counters->leaf_triangles += node.count;
      }
      if (!leaf(node)) return;
    } else {
      if constexpr (kCounting) {
        ++counters->inner_hits;
        counters->box_tests += 2;
      }
      const Interval left = slabs(bvh.nodes[node.first].bounds), right = slabs(bvh.nodes[node.first + 1].bounds);
      const bool meets_left = range.meets(left), meets_right = range.meets(right);
      const bool right_first = meets_right && (!meets_left || right.entry < left.entry);
      if (meets_left && meets_right) {
        RAYGRAIN_CHECK_LT(size, stack.size());
        stack[size++] = {node.first + (right_first ? 0 : 1), right_first ? left.entry : right.entry};
      }
      index = node.first + (right_first ? 1 : 0);
      if (meets_left || meets_right) continue;
    }
    do {
      if (size == 0) return;
      --size;
    } while (stack[size].entry > range.latest);  // entered exactly at the best t: still visited, ties go to lower ids
    index = stack[size].node;
  }
}

}  // namespace raygrain
