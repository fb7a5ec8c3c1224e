// A strategy as builders use it: empty injection points replaced by their defaults, every answer of user code checked.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "raygrain/build.h"

#include "build/input.h"

namespace raygrain::builder {

/// Where a heuristic failed: "node at level 3 with 17 primitives in box (0, 0, 0) to (1, 1, 1)".
std::string describe(const NodeContext& node);

/// Compares what rays that meet a node of this measure pay at it as a leaf (`leaf_cost` without the triangle's price),
/// and as an inner node over two leaves (`split_cost`, likewise). Never for more than `leaf_size` primitives.
inline bool is_leaf_cheaper(const BuildOptions& options, uint32_t count, float measure, double leaf_cost,
                            double split_cost) {
  if (count > options.leaf_size) return false;
  const double triangle = static_cast<double>(options.costs.triangle);
  return triangle * leaf_cost <=
         static_cast<double>(options.costs.inner) * static_cast<double>(measure) + triangle * split_cost;
}

/// One strategy of one build. Refers to the strategy that it was made from.
class ActiveStrategy {
 public:
  ActiveStrategy(const BuildStrategy& strategy, const PaperParameters& parameters, const CostModel& costs);

  /// Asks the measure for the probability's denominator; before the root is split.
  void set_total(const NodeContext& root);

  /// Measures of many boxes at `node`; throws kBadHeuristic unless all are finite and not negative.
  void measure(std::span<const Bounds> boxes, std::span<float> out, const NodeContext& node) const;
  float measure(const Bounds& box, const NodeContext& node) const;

  /// The node's axes; throws kBadHeuristic unless one to three valid ones.
  AxisOrder axes(const NodeContext& node) const;

  /// Cost of a leaf of `count` primitives; throws kBadHeuristic for NaN.
  double cost(float measure, uint32_t count, const NodeContext& node) const;

  bool stops(const NodeContext& node, float measure) const;
  SplitVerdict decide(const SplitState& state) const;

  bool has_preference() const { return static_cast<bool>(strategy_.preference); }
  bool prefers(const PlanePrice& candidate, const PlanePrice& best) const {
    return strategy_.preference(candidate, best);
  }

  bool has_hand_down() const { return static_cast<bool>(strategy_.hand_down); }
  /// The user's measures for the children; throws kBadHeuristic for a negative one or NaN.
  std::pair<float, float> hand_down(const SplitOutcome& outcome) const;

  bool has_planes() const { return static_cast<bool>(strategy_.planes); }
  /// The user's candidate planes; throws kBadHeuristic unless ascending and finite.
  void planes(const NodeContext& node, const Bounds& keys, int axis, std::vector<float>& out) const;

  bool has_partition() const { return static_cast<bool>(strategy_.partition); }
  /// Where a primitive stands along an axis; throws kBadHeuristic unless finite.
  float key(const Bounds& box, Vec3 centroid, int axis, const NodeContext& node) const {
    return has_partition() ? checked_key(box, centroid, axis, node) : centroid[axis];
  }

 private:
  float checked_key(const Bounds& box, Vec3 centroid, int axis, const NodeContext& node) const;

  const BuildStrategy& strategy_;
  const PaperParameters& parameters_;
  CostModel costs_;
  SplitOrientation orientation_;
  float total_ = 0;
};

}  // namespace raygrain::builder
