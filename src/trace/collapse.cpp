// Costs are computed bottom-up, for every node of the binary tree and every number of places in a wide node that its
// triangles may take; then a plan is made top-down from the choices that gave these costs; then it is written down.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "raygrain/error.h"

#include "trace/wide_tree.h"

namespace raygrain {
namespace {

/// A node of the binary tree with large leaves cut into halves; children come after their parents.
struct Binary {
  uint32_t left = 0, right = 0;   // 0: a leaf
  uint32_t first = 0, count = 0;  // a leaf's prims; `count` of an inner node: all triangles below
  bool merged = false;            // an inner node whose triangles are best put into one leaf
};

/// A node or leaf of the wide tree to be.
struct Item {
  uint32_t root;  // of the binary subtree
  uint32_t first_child = 0, children = 0;
  uint64_t offset = 0;
  ChildRef ref = 0;

  bool is_leaf() const { return children == 0; }
};

/// a - b in float, rounded down; exact where b is 0.
float difference_below(float a, float b) {
  if (b == 0) return a;
  const double exact = static_cast<double>(a) - static_cast<double>(b);  // but for one rounding
  const double low = exact - 0x1p-50 * std::abs(exact);
  const auto rounded = static_cast<float>(low);
  return rounded <= low ? rounded : std::nextafter(rounded, -kInf);
}
float difference_above(float a, float b) {
  return -difference_below(-a, -b);
}

class Collapse {
 public:
  Collapse(const Bvh& tree, const TriangleMesh& mesh, const WideOptions& options)
      : tree_(tree), mesh_(mesh), options_(options) {}

  WideTree run() {
    if (tree_.nodes.empty()) return {};
    copy_binary();
    measure_nodes();
    for (size_t i = binary_.size(); i-- > 0;) price(i);
    place_center();
    plan();
    leaf_bytes_ += kLeafSlack;
    wide_.memory = LineMemory(wide_.nodes * sizeof(WideNode) + leaf_bytes_);
    for (size_t i = items_.size(); i-- > 0;) items_[i].is_leaf() ? write_leaf(items_[i]) : write_node(items_[i]);
    return std::move(wide_);
  }

 private:
  using Costs = std::array<float, kWidth + 1>;  // [n]: of the triangles in at most n places; [0] is not used

  void copy_binary() {
    binary_.reserve(tree_.nodes.size());
    bounds_.reserve(tree_.nodes.size());
    for (const Bvh::Node& node : tree_.nodes) {
      binary_.push_back(node.is_leaf() ? Binary{0, 0, node.first, node.count}
                                       : Binary{node.first, node.first + 1, 0, 0});
      bounds_.push_back(node.bounds);
    }
    for (size_t i = 0; i < binary_.size(); ++i) halve_leaf(i);  // the new ones come up in their turn
    for (size_t i = binary_.size(); i-- > 0;) {
      Binary& node = binary_[i];
      if (node.left != 0) node.count = binary_[node.left].count + binary_[node.right].count;
    }
  }

  void halve_leaf(size_t index) {
    const Binary leaf = binary_[index];
    if (leaf.left != 0 || leaf.count <= options_.max_leaf_size) return;
    const auto child = static_cast<uint32_t>(binary_.size());
    const uint32_t half = leaf.count / 2;
    binary_[index] = {child, child + 1, 0, 0};
    for (const auto& [first, count] : {std::pair{leaf.first, half}, std::pair{leaf.first + half, leaf.count - half}}) {
      Bounds box;
      for (uint32_t k = first; k < first + count; ++k) box.extend(triangle_bounds(mesh_, tree_.prims[k]));
      binary_.push_back({0, 0, first, count});
      bounds_.push_back(box);
    }
  }

  void measure_nodes() {
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

  float node_cost(size_t i) const { return costs_[i][kWidth] + measures_[i] * options_.costs.node; }
  float leaf_cost(size_t i) const {
    return measures_[i] * (options_.costs.leaf + options_.costs.triangle * static_cast<float>(binary_[i].count));
  }
  float split_cost(size_t i, size_t places, size_t left_places) const {
    return costs_[binary_[i].left][left_places] + costs_[binary_[i].right][places - left_places];
  }

  void price(size_t i) {
    Costs& costs = costs_[i];
    if (binary_[i].left == 0) {
      costs.fill(leaf_cost(i));
      return;
    }
    for (size_t places = 2; places <= kWidth; ++places) {
      costs[places] = split_cost(i, places, 1);
      for (size_t n = 2; n < places; ++n) costs[places] = std::min(costs[places], split_cost(i, places, n));
    }
    costs[1] = node_cost(i);  // from the costs of its children in places 1 ... 8
    if (binary_[i].count <= options_.max_leaf_size && leaf_cost(i) <= costs[1]) {
      costs[1] = leaf_cost(i);
      binary_[i].merged = true;
    }
    for (size_t places = 2; places <= kWidth; ++places) costs[places] = std::min(costs[places], costs[places - 1]);
  }

  void place_center() {
    const Bounds& scene = bounds_[0];
    wide_.center = center(scene);
    for (int axis = 0; axis < 3; ++axis) {
      const float center = wide_.center[axis];
      wide_.reach =
          std::max({wide_.reach, -difference_below(scene.lo[axis], center), difference_above(scene.hi[axis], center)});
    }
  }

  /// Appends the subtrees that the triangles of `i` become in at most `places` places.
  void collect(uint32_t i, size_t places, std::vector<uint32_t>& roots) const {
    while (places > 1 && costs_[i][places] == costs_[i][places - 1]) --places;
    if (places == 1)
      roots.push_back(i);
    else
      collect_halves(i, places, roots);
  }
  void collect_halves(uint32_t i, size_t places, std::vector<uint32_t>& roots) const {
    size_t left = 1;
    for (size_t n = 2; n < places; ++n)
      if (split_cost(i, places, n) < split_cost(i, places, left)) left = n;
    collect(binary_[i].left, left, roots);
    collect(binary_[i].right, places - left, roots);
  }
  bool is_wide_leaf(uint32_t i) const { return binary_[i].left == 0 || binary_[i].merged; }

  void plan() {
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
        collect_halves(root, kWidth, roots);
      // The most probable first, for any hit.
      std::ranges::stable_sort(roots, std::greater<>(), [&](uint32_t i) { return measures_[i]; });
      plan_children(index, roots, pending);
    }
    if (node_bytes_ + leaf_bytes_ > uint64_t{1} << 43)
      throw Error(ErrorCode::kLimit, "WideBvh", "the tree takes more than 2^43 bytes");
  }

  void plan_children(uint32_t parent, const std::vector<uint32_t>& roots, std::vector<uint32_t>& pending) {
    const auto first = static_cast<uint32_t>(items_.size());
    items_[parent].first_child = first;
    items_[parent].children = static_cast<uint32_t>(roots.size());
    ++wide_.nodes;
    for (const uint32_t root : roots) items_.push_back({.root = root});
    for (size_t i = roots.size(); i-- > 0;) {
      const auto index = static_cast<uint32_t>(first + i);
      if (is_wide_leaf(roots[i])) {
        ++wide_.leaves;
        items_[index].offset = leaf_bytes_;  // from the first leaf
        leaf_bytes_ += binary_[roots[i]].count * kTriangleBytes;
      } else {
        items_[index].offset = node_bytes_;
        node_bytes_ += sizeof(WideNode);
        pending.push_back(index);
      }
    }
  }

  void gather(uint32_t i, std::vector<uint32_t>& ids) const {
    const Binary& node = binary_[i];
    if (node.left == 0) {
      for (uint32_t k = node.first; k < node.first + node.count; ++k) ids.push_back(tree_.prims[k]);
    } else {
      gather(node.left, ids);
      gather(node.right, ids);
    }
  }

  void write_leaf(Item& item) {
    ids_.clear();
    gather(item.root, ids_);
    const size_t count = ids_.size(), offset = wide_.nodes * sizeof(WideNode) + item.offset;
    auto* out = new (wide_.memory.data() + offset) float[10 * count];
    float size = 0;
    for (size_t lane = 0; lane < count; ++lane) {
      const std::array corners{mesh_.vertex(ids_[lane], 0), mesh_.vertex(ids_[lane], 1), mesh_.vertex(ids_[lane], 2)};
      for (int axis = 0; axis < 3; ++axis) {
        const float a = corners[0][axis], b = corners[1][axis], c = corners[2][axis];
        size = std::max(size, std::max({a, b, c}) - std::min({a, b, c}));
        float* const place = out + static_cast<size_t>(axis) * count + lane;
        place[0] = a;
        place[3 * count] = b;
        place[6 * count] = c;
      }
      out[9 * count + lane] = std::bit_cast<float>(ids_[lane]);
    }
    item.ref = leaf_ref(offset, static_cast<uint32_t>(count), std::nextafter(size, kInf));  // whatever was rounded
  }

  void write_node(Item& item) {
    auto* node = new (wide_.memory.data() + item.offset) WideNode{};
    for (size_t lane = 0; lane < kWidth; ++lane) {
      const bool is_there = lane < item.children;
      const Item* child = is_there ? &items_[item.first_child + lane] : nullptr;
      for (int axis = 0; axis < 3; ++axis) {
        const Bounds box = is_there ? bounds_[child->root] : Bounds{};
        const float center = wide_.center[axis];
        node->lower[axis][lane] = is_there ? difference_below(box.lo[axis], center) : kInf;
        node->upper[axis][lane] = is_there ? difference_above(box.hi[axis], center) : -kInf;
      }
      if (is_there) node->child[lane] = child->ref;
    }
    item.ref = node_ref(item.offset);
  }

  const Bvh& tree_;
  const TriangleMesh& mesh_;
  const WideOptions& options_;
  std::vector<Binary> binary_;
  std::vector<Bounds> bounds_;
  std::vector<float> measures_;
  std::vector<Costs> costs_;
  std::vector<Item> items_;  // children after their parents
  std::vector<uint32_t> ids_;
  uint64_t node_bytes_ = sizeof(WideNode), leaf_bytes_ = 0;
  WideTree wide_;
};

void validate(const WideOptions& options) {
  const auto check = [](bool good, const char* field, const char* range) {
    if (!good) throw Error(ErrorCode::kUsage, std::string("WideOptions::") + field, std::string("must be ") + range);
  };
  check(options.max_leaf_size >= 1 && options.max_leaf_size <= kWidth, "max_leaf_size", "1 ... 8");
  for (const float cost : {options.costs.node, options.costs.leaf, options.costs.triangle})
    check(cost >= 0 && cost <= 1e6f, "costs", "0 ... 1e6");
}

}  // namespace

WideTree collapse(const Bvh& tree, const TriangleMesh& mesh, const WideOptions& options) {
  validate(options);
  return Collapse(tree, mesh, options).run();
}

}  // namespace raygrain
