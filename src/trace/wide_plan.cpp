#include "trace/wide_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "raygrain/error.h"

#include "base/sort_few.h"

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
  costs_ = Buffer<float>(binary_.size() * form_.width + 1);
  for (size_t i = binary_.size(); i-- > 0;) price(i);
  plan();
}

void WidePlan::copy_binary() {
  binary_.reserve(tree_.nodes.size());
  bool has_large = false;
  for (const Bvh::Node& node : tree_.nodes) {
    binary_.push_back(node.is_leaf() ? Binary{0, node.first, node.count} : Binary{node.first, 0, 0});
    has_large |= node.count > options_.max_leaf_size;
  }
  if (has_large)
    for (size_t i = 0; i < binary_.size(); ++i) halve_leaf(i);  // the new ones come up in their turn
}

void WidePlan::halve_leaf(size_t index) {
  const Binary leaf = binary_[index];
  if (leaf.left != 0 || leaf.count <= options_.max_leaf_size) return;
  const uint32_t half = leaf.count / 2;
  binary_[index] = {static_cast<uint32_t>(binary_.size()), 0, 0};
  for (const auto& [first, count] : {std::pair{leaf.first, half}, std::pair{leaf.first + half, leaf.count - half}}) {
    Bounds half_box;
    for (uint32_t k = first; k < first + count; ++k) half_box.extend(form_.bounds(tree_.prims[k]));
    binary_.push_back({0, first, count});
    halves_.push_back(half_box);
  }
}

/// Some boxes at a time, side by side as measures want them.
void WidePlan::measure_nodes() {
  constexpr size_t kAtOnce = 256;
  measures_.resize(binary_.size());
  std::vector<Bounds> boxes(std::min(kAtOnce, binary_.size()));
  float greatest = 0;
  for (size_t begin = 0; begin < measures_.size(); begin += kAtOnce) {
    const size_t count = std::min(kAtOnce, measures_.size() - begin);
    for (size_t k = 0; k < count; ++k) boxes[k] = box(begin + k);
    options_.measure({boxes.data(), count}, {measures_.data() + begin, count});
    for (size_t i = begin; i < begin + count; ++i) {
      if (!(measures_[i] >= 0 && std::isfinite(measures_[i])))
        throw Error(ErrorCode::kBadHeuristic, "nodes[" + std::to_string(i) + "]",
                    "the measure is negative or not finite");
      greatest = std::max(greatest, measures_[i]);
    }
  }
  if (greatest > 0)  // sums of costs must stay in range
    for (float& measure : measures_) measure /= greatest;
}

float WidePlan::node_cost(size_t i) const {
  return costs(i)[form_.width] + measures_[i] * options_.costs.node;
}
float WidePlan::leaf_cost(size_t i) const {
  return measures_[i] * (options_.costs.leaf + options_.costs.triangle * static_cast<float>(binary_[i].count));
}
float WidePlan::split_cost(size_t i, size_t places, size_t left_places) const {
  const size_t left = binary_[i].left;
  return costs(left)[left_places] + costs(left + 1)[places - left_places];
}

void WidePlan::price(size_t i) {
  if (binary_[i].left != 0) return price_inner(i);
  std::fill_n(costs(i) + 1, form_.width, leaf_cost(i));
}

void WidePlan::price_inner(size_t i) {
  Binary& node = binary_[i];
  const Binary &left = binary_[node.left], &right = binary_[node.left + 1];
  node.count = left.count + right.count;
  node.leaves = static_cast<uint8_t>(std::min<size_t>(kMostWidth, size_t{left.leaves} + right.leaves));
  float* const best = costs(i);
  const float *const left_costs = costs(node.left), *const right_costs = costs(node.left + 1);
  const size_t useful = std::min<size_t>(form_.width, node.leaves);  // more places change nothing
  for (size_t places = 2; places <= useful; ++places) {
    float cost = left_costs[1] + right_costs[places - 1];
    for (size_t n = 2; n < places; ++n) cost = std::min(cost, left_costs[n] + right_costs[places - n]);
    best[places] = cost;
  }
  for (size_t places = useful + 1; places <= form_.width; ++places) best[places] = best[useful];
  best[1] = node_cost(i);  // from the costs of its children in all places of a node
  if (node.count <= options_.max_leaf_size && leaf_cost(i) <= best[1]) {
    best[1] = leaf_cost(i);
    node.merged = true;
  }
  for (size_t places = 2; places <= form_.width; ++places) best[places] = std::min(best[places], best[places - 1]);
}

/// Appends the subtrees that the triangles of `i` become in at most `places` places.
void WidePlan::collect(uint32_t i, size_t places, std::vector<uint32_t>& roots) const {
  while (places > 1 && costs(i)[places] == costs(i)[places - 1]) --places;
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
  collect(binary_[i].left + 1, places - left, roots);
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
    sort_few(std::span(roots), [&](uint32_t a, uint32_t b) { return measures_[a] < measures_[b]; });
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
    gather(node.left + 1, ids);
  }
}

}  // namespace raygrain
