// Writes down the plan of a wide tree in ray space.
#include <algorithm>
#include <cmath>
#include <vector>

#include "raygrain/error.h"

#include "base/parallel.h"
#include "geometry/frame_triangle.h"
#include "geometry/rounding.h"
#include "trace/frame_memory.h"
#include "trace/wide_plan.h"

namespace raygrain {
namespace {

Bounds bounds_of(const RayFrame& frame, const std::array<Vec3, 3>& corners) {
  return frame_bounds(frame, corners[0], corners[1], corners[2]);
}

void set_sizes(FrameMemory& tree, const Bounds& bounds) {
  tree.bounds = bounds;
  const auto size = [&](int axis) {
    return static_cast<double>(std::max(std::abs(bounds.lo[axis]), std::abs(bounds.hi[axis])));
  };
  tree.width = std::max(size(0), size(1));
  const double depth = size(2);
  constexpr double kLeast = 0x1p-30, kGreatest = 0x1p30;
  for (const double extent : {tree.width, depth})
    if (!(extent >= kLeast && extent <= kGreatest))
      throw Error(ErrorCode::kUsage, "FrameTree", "the tree is too small or too large in its frame for floats");
  tree.reach = 3 * tree.width;
  tree.edge_error = float_above(24 * 0x1p-24 * tree.reach);
  // Relative to each side: a projective frame's depths crowd before 0.
  const double margin = 0x1p-16;
  const auto out = [&](double z, double sign) {
    return z + sign * margin * (tree.frame.is_projective() ? std::abs(z) : depth);
  };
  tree.depths = {float_below(out(bounds.lo.z, -1)), float_above(out(bounds.hi.z, 1))};
  const double lo = tree.depths[0], hi = tree.depths[1];
  tree.middle = 0.5 * (lo + hi);
  tree.half = 0.5 * (hi - lo) * (1 + 0x1p-40);
  tree.depth = std::max(std::abs(lo), std::abs(hi));
  tree.farthest = !tree.frame.is_projective() ? tree.depth : hi < 0 ? -1 / hi : std::numeric_limits<double>::infinity();
  tree.least_slope = 0x1p-40 * tree.width / tree.depth;
}

class FrameWriter {
 public:
  FrameWriter(const WidePlan& plan, FrameMemory& tree, unsigned threads)
      : plan_(plan), tree_(tree), threads_(threads), refs_(plan.items().size()) {}

  void run() {
    const uint64_t bytes = plan_.node_bytes() + plan_.leaf_bytes() + kLeafSlack;
    if (bytes > kMostFrameBytes) throw Error(ErrorCode::kLimit, "FrameTree", "the tree takes more than 2^33 bytes");
    tree_.nodes = plan_.nodes();
    tree_.leaves = plan_.leaves();
    tree_.memory = LineMemory(bytes);
    write_leaves();
    write_nodes();
  }

 private:
  static constexpr size_t kItemsPerTask = 1024;

  /// And all references, which nodes hold of their children.
  void write_leaves() {
    parallel_for(refs_.size(), kItemsPerTask, threads_, [&](size_t begin, size_t end) {
      std::vector<uint32_t> ids;
      for (size_t i = begin; i < end; ++i) {
        const WideItem& item = plan_.items()[i];
        ids.clear();
        if (item.is_leaf()) plan_.gather(item, ids);
        refs_[i] = item.is_leaf() ? write_leaf(item, ids) : frame_ref(item.offset, 0);
      }
    });
  }

  void write_nodes() {
    parallel_for(refs_.size(), kItemsPerTask, threads_, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i)
        if (const WideItem& item = plan_.items()[i]; !item.is_leaf()) write_node(item);
    });
  }

  FrameRef write_leaf(const WideItem& item, std::span<const uint32_t> ids) {
    const size_t count = ids.size(), offset = plan_.node_bytes() + item.offset;
    auto* out = new (tree_.memory.data() + offset) float[2 + FrameLeaf::kFields * count];
    const auto field = [&](size_t k, size_t lane) -> float& { return out[2 + k * count + lane]; };
    const Bounds& leaf = plan_.bounds(item);
    double most_error = 0;
    for (size_t lane = 0; lane < count; ++lane) {
      const auto& [a, b, c] = tree_.corners->at_id(ids[lane]);
      const Bounds box = frame_bounds(tree_.frame, a, b, c, leaf);
      const FrameTriangle t = frame_triangle(tree_.frame, a, b, c, is_empty(box) ? leaf : box, tree_.reach);
      for (size_t k = 0; k < 3; ++k) {
        field(3 * k, lane) = static_cast<float>(t.edges[k].a);
        field(3 * k + 1, lane) = static_cast<float>(t.edges[k].b);
        field(3 * k + 2, lane) = static_cast<float>(t.edges[k].c);
      }
      field(FrameLeaf::kP, lane) = static_cast<float>(t.p);
      field(FrameLeaf::kQ, lane) = static_cast<float>(t.q);
      field(FrameLeaf::kR, lane) = static_cast<float>(t.r);
      field(FrameLeaf::kError, lane) = float_above(t.z_error * (1 + 0x1p-20));
      field(FrameLeaf::kId, lane) = stored_id(ids[lane]);
      most_error = std::max(most_error, t.z_error);
    }
    const double lo = leaf.lo.z, hi = leaf.hi.z, middle = 0.5 * (lo + hi);
    out[0] = static_cast<float>(middle);
    out[1] = float_above(0.5 * (hi - lo) + 2 * most_error + 0x1p-22 * std::abs(middle));
    return frame_ref(offset, count);
  }

  void write_node(const WideItem& item) {
    auto* node = new (tree_.memory.data() + item.offset) FrameNode{};
    std::array<size_t, kFrameWidth> children{};
    for (size_t i = 0; i < item.children; ++i) children[i] = item.first_child + i;
    const auto depth = [&](size_t child) { return plan_.bounds(plan_.items()[child]).lo.z; };
    std::stable_sort(children.begin(), children.begin() + item.children,
                     [&](size_t a, size_t b) { return depth(a) > depth(b); });
    for (size_t lane = 0; lane < kFrameWidth; ++lane) {
      const bool is_there = lane < item.children;
      const size_t child = children[lane];
      for (int axis = 0; axis < 3; ++axis) {
        node->lower[axis][lane] = is_there ? plan_.bounds(plan_.items()[child]).lo[axis] : kInf;
        node->upper[axis][lane] = is_there ? plan_.bounds(plan_.items()[child]).hi[axis] : -kInf;
      }
      if (is_there) node->child[lane] = refs_[child];
    }
  }

  const WidePlan& plan_;
  FrameMemory& tree_;
  const unsigned threads_;
  std::vector<FrameRef> refs_;  // by item
};

}  // namespace

FrameMemory write_frame_tree(const RayFrame& frame, const Bvh& tree, std::shared_ptr<const TriangleCorners> corners,
                             const WideOptions& options) {
  validate(options, kFrameWidth);
  FrameMemory result;
  result.frame = frame;
  result.corners = std::move(corners);
  if (tree.nodes.empty()) return result;
  const TriangleCorners& triangles = *result.corners;
  const WideForm form{kFrameWidth, sizeof(FrameNode), FrameLeaf::size,
                      [&](uint32_t triangle) { return bounds_of(frame, triangles.at_id(triangle)); }};
  const WidePlan plan(tree, options, form);
  set_sizes(result, plan.root_bounds());
  FrameWriter(plan, result, options.threads).run();
  return result;
}

}  // namespace raygrain
