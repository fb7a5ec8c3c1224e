// Which subtrees of a binary tree become the nodes and leaves of a wide one, and where they go in memory.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "raygrain/bvh.h"
#include "raygrain/wide.h"

#include "base/buffer.h"
#include "trace/wide_tree.h"

namespace raygrain {

/// Throws Error (kUsage, naming the field).
void validate(const WideOptions& options, size_t width = kWidth);

/// A node or leaf of the wide tree to be.
struct WideItem {
  uint32_t root;  // of the binary subtree
  uint32_t first_child = 0, children = 0;
  uint64_t offset = 0;  // of a node from the first node, of a leaf from the first leaf

  bool is_leaf() const { return children == 0; }
};

inline constexpr size_t kMostWidth = 16;

/// The form of what is written.
struct WideForm {
  size_t width;  // children of a node and triangles of a leaf, at most; no more than kMostWidth
  size_t node_bytes;
  std::function<size_t(size_t count)> leaf_bytes;    // of a leaf with so many primitives
  std::function<Bounds(uint32_t primitive)> bounds;  // for leaves that must be halved
};

/// The wide tree of least expected cost that has the binary tree's boxes, after Ylitie et al., "Efficient incoherent
/// ray traversal on GPUs through compressed wide BVHs" (2017), section 4.1, under any measure.
///
/// Costs are computed bottom-up, for every node of the binary tree and every number of places in a wide node that its
/// triangles may take; then a plan is made top-down from the choices that gave these costs. Both run on all threads,
/// subtree by subtree; the plan is the same for any number of them.
class WidePlan {
 public:
  /// `tree` is not empty and must outlive the plan. Throws as WideBvh's constructor.
  WidePlan(const Bvh& tree, const WideOptions& options, const WideForm& form);

  std::span<const WideItem> items() const { return all_.items; }  // children after their parents; the first is the root
  size_t nodes() const { return all_.nodes; }
  size_t leaves() const { return all_.leaves; }
  uint64_t node_bytes() const { return all_.node_bytes; }
  uint64_t leaf_bytes() const { return all_.leaf_bytes; }
  const Bounds& bounds(const WideItem& item) const { return box(item.root); }
  const Bounds& root_bounds() const { return tree_.nodes[0].bounds; }
  /// Appends the item's primitives.
  void gather(const WideItem& item, std::vector<uint32_t>& ids) const { gather(item.root, ids); }

 private:
  /// A node of the binary tree with large leaves cut into halves; children come after their parents, side by side.
  struct Binary {
    uint32_t left = 0;              // 0: a leaf
    uint32_t first = 0, count = 0;  // a leaf's prims; `count` of an inner node: all triangles below
    uint8_t leaves = 1;             // below, or itself; no more than kMostWidth
    bool merged = false;            // an inner node whose triangles are best put into one leaf
  };

  /// A piece of the plan: what becomes of a subtree's triangles. Places count from its own start; the first item is its
  /// root, whose place is known elsewhere.
  struct Part {
    std::vector<WideItem> items;
    size_t nodes = 0, leaves = 0;
    uint64_t node_bytes = 0, leaf_bytes = 0;
  };

  void copy_binary();
  void halve_leaf(size_t index);
  void measure_nodes();
  float measure_some(size_t begin, size_t end);
  void price_all();
  void price_subtree(uint32_t root);
  const Bounds& box(size_t i) const {
    return i < tree_.nodes.size() ? tree_.nodes[i].bounds : halves_[i - tree_.nodes.size()];
  }
  /// [n]: the cost of the node's triangles in at most n places; n from 1 to the form's width.
  float* costs(size_t i) { return costs_.elements().data() + i * form_.width; }
  const float* costs(size_t i) const { return costs_.elements().data() + i * form_.width; }
  float node_cost(size_t i) const;
  float leaf_cost(size_t i) const;
  float split_cost(size_t i, size_t places, size_t left_places) const;
  void price(size_t i);
  void price_inner(size_t i);
  void collect(uint32_t i, size_t places, std::vector<uint32_t>& roots) const;
  void collect_halves(uint32_t i, size_t places, std::vector<uint32_t>& roots) const;
  bool is_wide_leaf(uint32_t i) const { return binary_[i].left == 0 || binary_[i].merged; }
  void plan();
  void plan_part(Part& part, std::vector<uint32_t>* later) const;
  void plan_children(Part& part, uint32_t parent, const std::vector<uint32_t>& roots,
                     std::vector<uint32_t>& pending) const;
  void put_parts(const std::vector<uint32_t>& roots, const std::vector<Part>& parts);
  void gather(uint32_t i, std::vector<uint32_t>& ids) const;

  const Bvh& tree_;
  const WideOptions& options_;
  const WideForm& form_;
  std::vector<Binary> binary_;
  std::vector<Bounds> halves_;  // of leaves; their boxes
  std::vector<float> measures_;
  Buffer<float> costs_;  // `width` for each node, behind one that is not used
  Part all_;
};

}  // namespace raygrain
