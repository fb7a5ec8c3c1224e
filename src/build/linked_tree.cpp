#include "build/linked_tree.h"

#include <cmath>
#include <sstream>

#include "raygrain/error.h"

namespace raygrain::builder {

double checked_measure(const RayMeasure& measure, const Bounds& box) {
  const float value = measure(box);
  if (value >= 0 && std::isfinite(value)) return static_cast<double>(value);
  std::ostringstream message;
  message << "the measure returned " << value;
  throw Error(ErrorCode::kBadHeuristic, "reinsert", message.str(), "a measure must be finite and not negative");
}

LinkedTree::LinkedTree(const Bvh& bvh, const RayMeasure& measure) : nodes_(bvh.nodes.size()), measure_(measure) {
  for (uint32_t i = 0; i < size(); ++i) {
    const Bvh::Node& from = bvh.nodes[i];
    Node& node = nodes_[i];
    node.box = from.bounds;
    node.measure = static_cast<float>(checked_measure(measure, from.bounds));
    node.first = from.first;
    node.count = from.count;
    if (from.is_leaf()) continue;
    node.children = {from.first, from.first + 1};
    for (const uint32_t child : node.children) nodes_[child].parent = i;
  }
}

uint32_t LinkedTree::sibling(uint32_t i) const {
  const auto& children = nodes_[nodes_[i].parent].children;
  return children[0] == i ? children[1] : children[0];
}

/// The root and its children stay where they are.
bool LinkedTree::can_move(uint32_t node, uint32_t target) const {
  const uint32_t parent = nodes_[node].parent;
  if (parent == kNoNode || nodes_[parent].parent == kNoNode) return false;
  if (target == parent || nodes_[target].parent == kNoNode || target == sibling(node)) return false;
  for (uint32_t above = target; above != kNoNode; above = nodes_[above].parent)
    if (above == node) return false;
  return true;
}

void LinkedTree::replace_child(uint32_t parent, uint32_t old_child, uint32_t new_child) {
  auto& children = nodes_[parent].children;
  children[children[0] == old_child ? 0 : 1] = new_child;
  nodes_[new_child].parent = parent;
}

void LinkedTree::set_box(uint32_t node, const Bounds& box) {
  Node& changed = nodes_[node];
  changes_.push_back({node, changed.box, changed.measure});
  gain_ += static_cast<double>(changed.measure);
  changed.box = box;
  changed.measure = static_cast<float>(checked_measure(measure_, box));
  gain_ -= static_cast<double>(changed.measure);
}

void LinkedTree::fit(uint32_t node) {
  for (; node != kNoNode; node = nodes_[node].parent) {
    const Bounds box = united(nodes_[nodes_[node].children[0]].box, nodes_[nodes_[node].children[1]].box);
    if (box == nodes_[node].box) return;
    set_box(node, box);
  }
}

bool LinkedTree::move(uint32_t node, uint32_t target) {
  if (!can_move(node, target)) return false;
  const uint32_t parent = nodes_[node].parent, brother = sibling(node), grandparent = nodes_[parent].parent;
  changes_.clear();
  gain_ = 0;
  replace_child(grandparent, parent, brother);
  fit(grandparent);
  const uint32_t above = nodes_[target].parent;
  replace_child(above, target, parent);
  nodes_[parent].children = {target, node};
  nodes_[target].parent = parent;
  set_box(parent, united(nodes_[target].box, nodes_[node].box));
  fit(above);
  if (gain_ > 0) return true;

  for (size_t i = changes_.size(); i-- > 0;) {
    nodes_[changes_[i].node].box = changes_[i].box;
    nodes_[changes_[i].node].measure = changes_[i].measure;
  }
  replace_child(above, parent, target);
  replace_child(grandparent, brother, parent);
  nodes_[parent].children = {brother, node};
  nodes_[brother].parent = parent;
  return false;
}

Bvh LinkedTree::laid_out(const Bvh& original) const {
  struct Visit {
    uint32_t from, to;
  };
  Bvh bvh;
  bvh.split_references = original.split_references;
  bvh.nodes.resize(nodes_.size());
  bvh.prims.reserve(original.prims.size());
  std::vector<Visit> open{{0, 0}};
  uint32_t next = 1;
  while (!open.empty()) {
    const auto [from, to] = open.back();
    open.pop_back();
    const Node& node = nodes_[from];
    if (node.is_leaf()) {
      bvh.nodes[to] = {node.box, static_cast<uint32_t>(bvh.prims.size()), node.count};
      const auto first = original.prims.begin() + node.first;
      bvh.prims.insert(bvh.prims.end(), first, first + node.count);
      continue;
    }
    bvh.nodes[to] = {node.box, next, 0};
    open.push_back({node.children[1], next + 1});
    open.push_back({node.children[0], next});
    next += 2;
  }
  return bvh;
}

}  // namespace raygrain::builder
