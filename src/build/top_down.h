// The loop that all top-down builders share: a bounded stack of open nodes, leaf or split, children in place.
#pragma once

#include <functional>
#include <span>

#include "build/bins.h"
#include "build/laps.h"
#include "build/strategy.h"

namespace raygrain::builder {

/// A node whose box and primitives are known and that is not yet a leaf or split.
struct OpenNode {
  NodeContext context;
  float measure = 0;              // under the strategy that judges it
  uint32_t index = 0, first = 0;  // in Bvh::nodes, in Bvh::prims
};

/// What a builder answers.
struct Splitter {
  /// Called once, before anything else.
  std::function<void(const NodeContext& root)> start;

  /// The strategy that judges nodes of a level.
  std::function<const ActiveStrategy&(uint32_t level)> judge;

  /// A way to split the node, or no choice for a leaf. Both measures are the judge's of the node itself.
  std::function<Choice(const OpenNode&, std::span<const uint32_t> prims, NodeLog&)> choose;

  bool hands_down = false;  // BuildStrategy::hand_down is asked
};

/// Depth first, left before right; children are allocated in pairs. The stack holds at most one node per level and one
/// more. Leaves: what the judge's stop rule says, single primitives, and the level kMaxTreeLevels.
Bvh build_top_down(const Input& input, const BuildOptions& options, const Splitter& splitter, Laps& laps,
                   BuildLog* log);

/// The root of a tree, and the children of a node (side 1 or 2).
NodeContext root_context(const Bounds& bounds, uint32_t count, uint64_t seed);
NodeContext child_context(const NodeContext& parent, const Bounds& bounds, uint32_t count, int axis, uint64_t side);

/// The box of the primitives' keys along x, y and z under the strategy's partition rule.
Bounds key_box(const Input& input, std::span<const uint32_t> prims, const ActiveStrategy& strategy,
               const NodeContext& node);

/// The split for primitives that no candidate plane separates (BuildOptions::split_inseparable): slices of the box of
/// their keys along its longest axis; where all keys coincide, the list in two halves if they are too many for a leaf.
Choice split_inseparable(const Input& input, std::span<const uint32_t> prims, const ActiveStrategy& strategy,
                         const NodeContext& node, const BuildOptions& options, AxisBins& bins);

/// Prices the list cut in two halves, in its order.
Choice halve(const Input& input, std::span<const uint32_t> prims, const ActiveStrategy& strategy,
             const NodeContext& node);

/// Equation 4 of the paper: (left + right) / node. Infinite where the measure of the node is 0: it says nothing about
/// the split then.
float children_ratio(const Choice& choice, float node_measure);

}  // namespace raygrain::builder
