#include "trace/wide_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "raygrain/error.h"

namespace raygrain {

void validate(const WideOptions& options, size_t width) {
  const auto check = [](bool good, const char* field, const char* range) {
    if (!good) throw Error(ErrorCode::kUsage, std::string("WideOptions::") + field, std::string("must be ") + range);
  };
  check(options.max_leaf_size >= 1 && options.max_leaf_size <= width, "max_leaf_size",
        width == kWidth ? "1 ... 8" : "1 ... 16");
  for (const float cost : {options.costs.node, options.costs.leaf, options.costs.triangle})
    check(cost >= 0 && cost <= 1e6f, "costs", "0 ... 1e6");
}

WidePlan::WidePlan(const Bvh& tree, const WideOptions& options, const WideForm& form)
    : tree_(tree), options_(options), form_(form), node_bytes_(form.node_bytes) {
  validate(options, form.width);
  copy_binary();
  measure_nodes();
  for (size_t i = binary_.size(); i-- > 0;) price(i);
  plan();
}

void WidePlan::copy_binary() {
  binary_.reserve(tree_.nodes.size());
  bounds_.reserve(tree_.nodes.size());
  for (const Bvh::Node& node : tree_.nodes) {
    binary_.push_back(node.is_leaf() ? Binary{0, 0, node.first, node.count} : Binary{node.first, node.first + 1, 0, 0});
    bounds_.push_back(node.bounds);
  }
  for (size_t i = 0; i < binary_.size(); ++i) halve_leaf(i);  // the new ones come up in their turn
  for (size_t i = binary_.size(); i-- > 0;) {
    Binary& node = binary_[i];
    if (node.left == 0) continue;
    node.count = binary_[node.left].count + binary_[node.right].count;
    node.leaves = binary_[node.left].leaves + binary_[node.right].leaves;
  }
}

void WidePlan::halve_leaf(size_t index) {
  const Binary leaf = binary_[index];
  if (leaf.left != 0 || leaf.count <= options_.max_leaf_size) return;
  const auto child = static_cast<uint32_t>(binary_.size());
  const uint32_t half = leaf.count / 2;
  binary_[index] = {child, child + 1, 0, 0};
  for (const auto& [first, count] : {std::pair{leaf.first, half}, std::pair{leaf.first + half, leaf.count - half}}) {
    Bounds box;
    for (uint32_t k = first; k < first + count; ++k) box.extend(form_.bounds(tree_.prims[k]));
    binary_.push_back({0, 0, first, count});
    bounds_.push_back(box);
  }
}

void WidePlan::measure_nodes() {
  measures_.resize(bounds_.size());
  options_.measure(bounds_, measures_);
  for (size_t i = 0; i < measures_.size(); ++i)
    if (!(measures_[i] >= 0 && std::isfinite(measures_[i])))
      throw Error(ErrorCode::kBadHeuristic, "nodes[" + std::to_string(i) + "]",
                  "the measure is negative or not finite");
  const float greatest = *std::ranges::max_element(measures_);  // sums of costs must stay in range
  if (greatest > 0)
    for (float& measure : measures_) measure /= greatest;
  costs_.resize(binary_.size());
}

float WidePlan::node_cost(size_t i) const {
  return costs_[i][form_.width] + measures_[i] * options_.costs.node;
}
float WidePlan::leaf_cost(size_t i) const {
  return measures_[i] * (options_.costs.leaf + options_.costs.triangle * static_cast<float>(binary_[i].count));
}
float WidePlan::split_cost(size_t i, size_t places, size_t left_places) const {
  return costs_[binary_[i].left][left_places] + costs_[binary_[i].right][places - left_places];
}

void WidePlan::price(size_t i) {
  Costs& costs = costs_[i];
  if (binary_[i].left == 0) {
    costs.fill(leaf_cost(i));
    return;
  }
  const size_t useful = std::min<size_t>(form_.width, binary_[i].leaves);  // more places change nothing
  for (size_t places = 2; places <= useful; ++places) {
    costs[places] = split_cost(i, places, 1);
    for (size_t n = 2; n < places; ++n) costs[places] = std::min(costs[places], split_cost(i, places, n));
  }
  for (size_t places = useful + 1; places <= form_.width; ++places) costs[places] = costs[useful];
  costs[1] = node_cost(i);  // from the costs of its children in places 1 ... 8
  if (binary_[i].count <= options_.max_leaf_size && leaf_cost(i) <= costs[1]) {
    costs[1] = leaf_cost(i);
    binary_[i].merged = true;
  }
  for (size_t places = 2; places <= form_.width; ++places) costs[places] = std::min(costs[places], costs[places - 1]);
}

/// Appends the subtrees that the triangles of `i` become in at most `places` places.
void WidePlan::collect(uint32_t i, size_t places, std::vector<uint32_t>& roots) const {
  while (places > 1 && costs_[i][places] == costs_[i][places - 1]) --places;
  if (places == 1)
    roots.push_back(i);
  else
    collect_halves(i, places, roots);
}
void WidePlan::collect_halves(uint32_t i, size_t places, std::vector<uint32_t>& roots) const {
  size_t left = 1;
  for (size_t n = 2; n < places; ++n)
    if (split_cost(i, places, n) < split_cost(i, places, left)) left = n;
  collect(binary_[i].left, left, roots);
  collect(binary_[i].right, places - left, roots);
}
void WidePlan::plan() {
  items_.push_back({.root = 0});
  std::vector<uint32_t> pending{0}, roots;
  while (!pending.empty()) {  // depth first, so that subtrees stay together
    const uint32_t index = pending.back();
    pending.pop_back();
    const uint32_t root = items_[index].root;
    roots.clear();
    if (is_wide_leaf(root))
      roots.push_back(root);  // the whole tree is one leaf: the only child of the root node
    else
      collect_halves(root, form_.width, roots);
    // The most probable last: any hit takes the last first.
    std::ranges::stable_sort(roots, {}, [&](uint32_t i) { return measures_[i]; });
    plan_children(index, roots, pending);
  }
  if (node_bytes_ + leaf_bytes_ > uint64_t{1} << 43)
    throw Error(ErrorCode::kLimit, "WideBvh", "the tree takes more than 2^43 bytes");
}

void WidePlan::plan_children(uint32_t parent, const std::vector<uint32_t>& roots, std::vector<uint32_t>& pending) {
  const auto first = static_cast<uint32_t>(items_.size());
  items_[parent].first_child = first;
  items_[parent].children = static_cast<uint32_t>(roots.size());
  ++nodes_;
  for (const uint32_t root : roots) items_.push_back({.root = root});
  for (size_t i = roots.size(); i-- > 0;) {
    const auto index = static_cast<uint32_t>(first + i);
    if (is_wide_leaf(roots[i])) {
      ++leaves_;
      items_[index].offset = leaf_bytes_;  // from the first leaf
      leaf_bytes_ += form_.leaf_bytes(binary_[roots[i]].count);
    } else {
      items_[index].offset = node_bytes_;
      node_bytes_ += form_.node_bytes;
      pending.push_back(index);
    }
  }
}

void WidePlan::gather(uint32_t i, std::vector<uint32_t>& ids) const {
  const Binary& node = binary_[i];
  if (node.left == 0) {
    for (uint32_t k = node.first; k < node.first + node.count; ++k) ids.push_back(tree_.prims[k]);
  } else {
    gather(node.left, ids);
    gather(node.right, ids);
  }
}

}  // namespace raygrain
