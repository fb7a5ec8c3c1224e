// Validation of trees from anywhere: reads nothing out of range and ends, whatever the links say.
#include <cmath>
#include <string>
#include <vector>

#include "raygrain/bvh.h"

namespace raygrain {

namespace {

using Defect = std::optional<std::string>;

struct Visit {
  uint32_t node, level;
};

bool has_nan(const Bounds& b) {
  return std::isnan(b.lo.x) || std::isnan(b.lo.y) || std::isnan(b.lo.z) || std::isnan(b.hi.x) || std::isnan(b.hi.y) ||
         std::isnan(b.hi.z);
}

class Validation {
 public:
  Validation(const Bvh& bvh, std::span<const Bounds> boxes) : bvh_(bvh), boxes_(boxes) {}

  Defect run(std::span<const uint32_t> expected) {
    if (Defect defect = mark_expected(expected)) return defect;
    if (bvh_.split_references) {
      covered_.assign(boxes_.size(), Bounds{});
      last_leaf_.assign(boxes_.size(), kNoLeaf);
    }
    if (bvh_.nodes.empty()) return check_empty();
    reached_.assign(bvh_.nodes.size(), false);
    reached_[0] = true;
    std::vector<Visit> open{{0, 0}};
    // Every node is pushed at most once (`reached_`), so this ends.
    while (!open.empty()) {
      const Visit visit = open.back();
      open.pop_back();
      if (Defect defect = check_node(visit)) return defect;
      if (bvh_.nodes[visit.node].is_leaf()) {
        if (Defect defect = check_leaf(visit.node)) return defect;
        continue;
      }
      if (Defect defect = check_children(visit.node)) return defect;
      const uint32_t first = bvh_.nodes[visit.node].first;
      open.push_back({first + 1, visit.level + 1});
      open.push_back({first, visit.level + 1});
    }
    return check_complete();
  }

 private:
  static std::string node_name(size_t node) { return "node " + std::to_string(node); }

  static std::string holds(size_t node, uint32_t prim) {
    return node_name(node) + " holds primitive " + std::to_string(prim);
  }

  Defect mark_expected(std::span<const uint32_t> expected) {
    missing_.assign(boxes_.size(), expected.empty());
    for (const uint32_t prim : expected) {
      if (prim >= boxes_.size()) return "expected primitive " + std::to_string(prim) + " has no box";
      missing_[prim] = true;
    }
    return std::nullopt;
  }

  Defect check_empty() const {
    if (!bvh_.prims.empty()) return "a tree without nodes lists " + std::to_string(bvh_.prims.size()) + " primitives";
    return check_all_found();
  }

  Defect check_node(const Visit& visit) const {
    if (visit.level > kMaxTreeLevels)
      return node_name(visit.node) + " is deeper than " + std::to_string(kMaxTreeLevels) + " levels";
    if (has_nan(bvh_.nodes[visit.node].bounds)) return node_name(visit.node) + " has NaN in its box";
    return std::nullopt;
  }

  Defect check_children(uint32_t node) {
    const Bvh::Node& parent = bvh_.nodes[node];
    if (parent.first <= node) return node_name(node) + " has children that do not stand after it";
    if (size_t{parent.first} + 1 >= bvh_.nodes.size()) return node_name(node) + " has children out of range";
    for (size_t child = parent.first; child < size_t{parent.first} + 2; ++child) {
      if (reached_[child]) return node_name(node) + " shares its child " + std::to_string(child) + " with another node";
      reached_[child] = true;
      if (!contains(parent.bounds, bvh_.nodes[child].bounds) && !has_nan(bvh_.nodes[child].bounds))
        return node_name(node) + " does not hold the box of its child " + std::to_string(child);
    }
    return std::nullopt;
  }

  Defect check_leaf(uint32_t node) {
    const Bvh::Node& leaf = bvh_.nodes[node];
    const size_t end = size_t{leaf.first} + leaf.count;
    if (end > bvh_.prims.size()) return node_name(node) + " has primitives out of range";
    for (size_t i = leaf.first; i < end; ++i) {
      const uint32_t prim = bvh_.prims[i];
      if (prim >= boxes_.size()) return holds(node, prim) + ", which has no box";
      if (bvh_.split_references) {
        if (Defect defect = check_part(node, prim)) return defect;
        continue;
      }
      if (!missing_[prim]) return holds(node, prim) + ", which another leaf holds too or which is not expected";
      missing_[prim] = false;
      if (!contains(leaf.bounds, boxes_[prim])) return holds(node, prim) + ", which is not inside its box";
    }
    listed_ += leaf.count;
    return std::nullopt;
  }

  /// Which part of a primitive a leaf answers for cannot be seen here: only that all leaves together reach far enough.
  Defect check_part(uint32_t node, uint32_t prim) {
    if (!missing_[prim]) return holds(node, prim) + ", which is not expected";
    if (last_leaf_[prim] == node) return holds(node, prim) + " twice";
    last_leaf_[prim] = node;
    const Bounds& box = bvh_.nodes[node].bounds;
    if (is_empty(intersected(box, boxes_[prim]))) return holds(node, prim) + ", which does not reach into its box";
    covered_[prim].extend(box);
    return std::nullopt;
  }

  Defect check_covered() const {
    for (size_t prim = 0; prim < missing_.size(); ++prim)
      if (missing_[prim] && !is_empty(covered_[prim]) && !contains(covered_[prim], boxes_[prim]))
        return "primitive " + std::to_string(prim) + " reaches beyond all leaves that hold it";
    return std::nullopt;
  }

  Defect check_all_found() const {
    if (bvh_.split_references && !bvh_.nodes.empty()) {
      for (size_t prim = 0; prim < missing_.size(); ++prim)
        if (missing_[prim] && last_leaf_[prim] == kNoLeaf)
          return "primitive " + std::to_string(prim) + " is in no leaf";
      return check_covered();
    }
    for (size_t prim = 0; prim < missing_.size(); ++prim)
      if (missing_[prim]) return "primitive " + std::to_string(prim) + " is in no leaf";
    return std::nullopt;
  }

  Defect check_complete() const {
    for (size_t node = 0; node < reached_.size(); ++node)
      if (!reached_[node]) return node_name(node) + " is not reached from the root";
    if (Defect defect = check_all_found()) return defect;
    if (listed_ != bvh_.prims.size())
      return std::to_string(bvh_.prims.size() - listed_) + " entries of the primitive list are in no leaf";
    return std::nullopt;
  }

  const Bvh& bvh_;
  std::span<const Bounds> boxes_;
  static constexpr uint32_t kNoLeaf = ~uint32_t{0};
  std::vector<bool> missing_, reached_;  // of split references: expected, whether found or not
  std::vector<Bounds> covered_;          // split references only: the boxes of a primitive's leaves
  std::vector<uint32_t> last_leaf_;
  size_t listed_ = 0;
};

}  // namespace

std::optional<std::string> find_defect(const Bvh& bvh, std::span<const Bounds> primitive_bounds,
                                       std::span<const uint32_t> expected_prims) {
  return Validation(bvh, primitive_bounds).run(expected_prims);
}

}  // namespace raygrain
