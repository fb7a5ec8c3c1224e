#include "trace/wide_plan.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "raygrain/error.h"

#include "base/parallel.h"
#include "base/sort_few.h"

namespace raygrain {

namespace {
constexpr size_t kNodesPerTask = 16384, kTrianglesPerPart = 8192;
}

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
    : tree_(tree), options_(options), form_(form) {
  validate(options, form.width);
  copy_binary();
  measure_nodes();
  price_all();
  plan();
}

void WidePlan::copy_binary() {
  binary_.resize(tree_.nodes.size());
  std::atomic<bool> has_large = false;
  parallel_for(binary_.size(), kNodesPerTask, options_.threads, [&](size_t begin, size_t end) {
    bool some_are_large = false;
    for (size_t i = begin; i < end; ++i) {
      const Bvh::Node& node = tree_.nodes[i];
      binary_[i] = node.is_leaf() ? Binary{0, node.first, node.count} : Binary{node.first, 0, 0};
      some_are_large |= node.count > options_.max_leaf_size;
    }
    if (some_are_large) has_large = true;
  });
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

void WidePlan::measure_nodes() {
  measures_.resize(binary_.size());
  std::vector<float> greatest((binary_.size() + kNodesPerTask - 1) / kNodesPerTask);
  parallel_for(binary_.size(), kNodesPerTask, options_.threads,
               [&](size_t begin, size_t end) { greatest[begin / kNodesPerTask] = measure_some(begin, end); });
  const float most = *std::max_element(greatest.begin(), greatest.end());
  const auto bad = [](float measure) { return !(measure >= 0 && std::isfinite(measure)); };
  if (!std::isfinite(most))
    throw Error(
        ErrorCode::kBadHeuristic,
        "nodes[" + std::to_string(std::find_if(measures_.begin(), measures_.end(), bad) - measures_.begin()) + "]",
        "the measure is negative or not finite");
  if (!(most > 0)) return;
  parallel_for(binary_.size(), kNodesPerTask, options_.threads, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) measures_[i] /= most;  // sums of costs must stay in range
  });
}

/// Some boxes at a time, side by side as measures want them. The greatest; infinity where one is none.
float WidePlan::measure_some(size_t begin, size_t end) {
  constexpr size_t kAtOnce = 256;
  std::array<Bounds, kAtOnce> boxes;
  float greatest = 0;
  for (; begin < end; begin += kAtOnce) {
    const size_t count = std::min(kAtOnce, end - begin);
    for (size_t k = 0; k < count; ++k) boxes[k] = box(begin + k);
    options_.measure({boxes.data(), count}, {measures_.data() + begin, count});
    for (size_t i = begin; i < begin + count; ++i)
      greatest = measures_[i] >= 0 ? std::max(greatest, measures_[i]) : kInf;
  }
  return greatest;
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

/// The subtrees below some upper nodes on all threads, then these nodes.
void WidePlan::price_all() {
  constexpr size_t kSubtrees = 256;
  costs_ = Buffer<float>(binary_.size() * form_.width + 1);
  std::vector<uint32_t> nodes{0};  // parents before children
  size_t upper = 0;
  for (; upper < nodes.size() && nodes.size() - upper < kSubtrees; ++upper)
    if (const uint32_t left = binary_[nodes[upper]].left; left != 0) nodes.insert(nodes.end(), {left, left + 1});
  const unsigned threads = binary_.size() < kNodesPerTask ? 1 : options_.threads;
  parallel_for(nodes.size() - upper, 1, threads, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) price_subtree(nodes[upper + i]);
  });
  while (upper-- > 0) price(nodes[upper]);
}

void WidePlan::price_subtree(uint32_t root) {
  std::vector<uint32_t> below, open{root};
  while (!open.empty()) {
    below.push_back(open.back());
    open.pop_back();
    if (const uint32_t left = binary_[below.back()].left; left != 0) open.insert(open.end(), {left + 1, left});
  }
  for (size_t i = below.size(); i-- > 0;) price(below[i]);
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

/// First the upper nodes, then what is below them, part by part.
void WidePlan::plan() {
  all_.items.push_back({.root = 0});
  all_.node_bytes = form_.node_bytes;
  std::vector<uint32_t> later;
  plan_part(all_, &later);
  std::vector<Part> parts(later.size());
  parallel_for(parts.size(), 1, options_.threads, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      parts[i].items.reserve(binary_[all_.items[later[i]].root].count / 2);
      parts[i].items.push_back({.root = all_.items[later[i]].root});
      plan_part(parts[i], nullptr);
    }
  });
  put_parts(later, parts);
  if (all_.node_bytes + all_.leaf_bytes > uint64_t{1} << 43)
    throw Error(ErrorCode::kLimit, "WideBvh", "the tree takes more than 2^43 bytes");
}

/// From the part's first item down; `later`: gets the items of small subtrees, which are left alone.
void WidePlan::plan_part(Part& part, std::vector<uint32_t>* later) const {
  std::vector<uint32_t> pending{0}, roots;
  while (!pending.empty()) {  // depth first, so that subtrees stay together
    const uint32_t index = pending.back();
    pending.pop_back();
    const uint32_t root = part.items[index].root;
    if (later != nullptr && index != 0 && binary_[root].count <= kTrianglesPerPart) {
      later->push_back(index);
      continue;
    }
    roots.clear();
    if (is_wide_leaf(root))
      roots.push_back(root);  // the whole tree is one leaf: the only child of the root node
    else
      collect_halves(root, form_.width, roots);
    // The most probable last: any hit takes the last first.
    sort_few(std::span(roots), [&](uint32_t a, uint32_t b) { return measures_[a] < measures_[b]; });
    plan_children(part, index, roots, pending);
  }
}

void WidePlan::plan_children(Part& part, uint32_t parent, const std::vector<uint32_t>& roots,
                             std::vector<uint32_t>& pending) const {
  const auto first = static_cast<uint32_t>(part.items.size());
  part.items[parent].first_child = first;
  part.items[parent].children = static_cast<uint32_t>(roots.size());
  ++part.nodes;
  for (const uint32_t root : roots) part.items.push_back({.root = root});
  for (size_t i = roots.size(); i-- > 0;) {
    const auto index = static_cast<uint32_t>(first + i);
    if (is_wide_leaf(roots[i])) {
      ++part.leaves;
      part.items[index].offset = part.leaf_bytes;  // from the first leaf
      part.leaf_bytes += form_.leaf_bytes(binary_[roots[i]].count);
    } else {
      part.items[index].offset = part.node_bytes;
      part.node_bytes += form_.node_bytes;
      pending.push_back(index);
    }
  }
}

/// Each part goes behind those before it; `roots` are its root's places among all items.
void WidePlan::put_parts(const std::vector<uint32_t>& roots, const std::vector<Part>& parts) {
  std::vector<Part> before(parts.size());  // bytes of all before each part
  std::vector<uint32_t> places(parts.size());
  size_t size = all_.items.size();
  for (size_t i = 0; i < parts.size(); ++i) {
    places[i] = static_cast<uint32_t>(size - 1);  // of its first item, if it had a place there
    size += parts[i].items.size() - 1;
    before[i].node_bytes = std::exchange(all_.node_bytes, all_.node_bytes + parts[i].node_bytes);
    before[i].leaf_bytes = std::exchange(all_.leaf_bytes, all_.leaf_bytes + parts[i].leaf_bytes);
    all_.nodes += parts[i].nodes;
    all_.leaves += parts[i].leaves;
  }
  all_.items.resize(size);
  parallel_for(parts.size(), 1, options_.threads, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      for (size_t k = 0; k < parts[i].items.size(); ++k) {
        WideItem item = parts[i].items[k];
        if (!item.is_leaf()) item.first_child += places[i];
        item.offset += item.is_leaf() ? before[i].leaf_bytes : before[i].node_bytes;
        if (k == 0) item.offset = all_.items[roots[i]].offset;
        all_.items[k == 0 ? roots[i] : places[i] + k] = item;
      }
  });
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
