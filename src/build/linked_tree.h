// A tree whose nodes know their parents and whose children stand anywhere: what reinsertion changes in place.
#pragma once

#include <array>
#include <vector>

#include "raygrain/bvh.h"
#include "raygrain/measure.h"

namespace raygrain::builder {

inline constexpr uint32_t kNoNode = ~uint32_t{0};

/// Measures one box; throws Error kBadHeuristic unless finite and not negative.
double checked_measure(const RayMeasure& measure, const Bounds& box);

class LinkedTree {
 public:
  struct Node {
    Bounds box;
    float measure = 0;
    uint32_t parent = kNoNode;
    std::array<uint32_t, 2> children{kNoNode, kNoNode};  // none: a leaf
    uint32_t first = 0, count = 0;

    bool is_leaf() const { return children[0] == kNoNode; }
  };

  LinkedTree(const Bvh& bvh, const RayMeasure& measure);

  const Node& operator[](uint32_t i) const { return nodes_[i]; }
  uint32_t size() const { return static_cast<uint32_t>(nodes_.size()); }
  uint32_t sibling(uint32_t i) const;

  /// Takes the subtree `node` out, with its parent, and makes it the sibling of `target`. Returns false, and changes
  /// nothing, where that does not lower the sum of inner measures or cannot be.
  bool move(uint32_t node, uint32_t target);

  /// Children in pairs after their parent, depth first, with primitives in the order of the leaves.
  Bvh laid_out(const Bvh& original) const;

 private:
  struct Change {
    uint32_t node;
    Bounds box;
    float measure;
  };
  bool can_move(uint32_t node, uint32_t target) const;
  void replace_child(uint32_t parent, uint32_t old_child, uint32_t new_child);
  /// Fits boxes from `node` upwards until nothing changes.
  void fit(uint32_t node);
  void set_box(uint32_t node, const Bounds& box);

  std::vector<Node> nodes_;
  const RayMeasure& measure_;
  std::vector<Change> changes_;  // of the move under way
  double gain_ = 0;
};

}  // namespace raygrain::builder
