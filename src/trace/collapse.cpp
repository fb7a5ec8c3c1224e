// Writes down the plan of a wide tree in the world's coordinates.
#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "geometry/rounding.h"
#include "trace/wide_plan.h"
#include "trace/wide_tree.h"

namespace raygrain {
namespace {

constexpr size_t kItemsPerTask = 4096, kItemsAtOnce = 16;

/// A hint, no more.
inline void fetch([[maybe_unused]] const void* address) {
#ifdef __GNUC__  // and Clang
  __builtin_prefetch(address);
#endif
}

/// a - b in float, rounded down; exact where b is 0.
float difference_below(float a, float b) {
  if (b == 0) return a;
  const double exact = static_cast<double>(a) - static_cast<double>(b);  // but for one rounding
  const double low = exact - 0x1p-50 * std::abs(exact);
  return float_below(low);
}
float difference_above(float a, float b) {
  return -difference_below(-a, -b);
}

class Collapse {
 public:
  Collapse(const WidePlan& plan, const TriangleMesh& mesh, unsigned threads)
      : plan_(plan), mesh_(mesh), threads_(threads), refs_(plan.items().size()) {}

  WideTree run() {
    wide_.nodes = plan_.nodes();
    wide_.leaves = plan_.leaves();
    place_center();
    wide_.memory = LineMemory(plan_.node_bytes() + plan_.leaf_bytes() + kLeafSlack);
    write_leaves();
    write_nodes();
    return std::move(wide_);
  }

 private:
  void place_center() {
    const Bounds& scene = plan_.root_bounds();
    wide_.center = center(scene);
    for (int axis = 0; axis < 3; ++axis) {
      const float center = wide_.center[axis];
      wide_.reach =
          std::max({wide_.reach, -difference_below(scene.lo[axis], center), difference_above(scene.hi[axis], center)});
    }
  }

  /// And all references, which nodes hold of their children.
  void write_leaves() {
    parallel_for(refs_.size(), kItemsPerTask, threads_, [&](size_t begin, size_t end) {
      std::vector<uint32_t> ids;
      for (size_t i = begin; i < end; i += kItemsAtOnce) write_some_leaves(i, std::min(end, i + kItemsAtOnce), ids);
    });
  }

  /// First all ids, so that vertices are on their way from memory when they are wanted.
  void write_some_leaves(size_t begin, size_t end, std::vector<uint32_t>& ids) {
    ids.clear();
    std::array<size_t, kItemsAtOnce> ends{};
    for (size_t i = begin; i < end; ++i) {
      if (plan_.items()[i].is_leaf()) plan_.gather(plan_.items()[i], ids);
      ends[i - begin] = ids.size();
    }
    for (const uint32_t id : ids) fetch(&mesh_.triangles[id]);
    for (const uint32_t id : ids)
      for (const uint32_t vertex : mesh_.triangles[id]) fetch(&mesh_.vertices[vertex]);
    size_t first = 0;
    for (size_t i = begin; i < end; first = ends[i++ - begin]) {
      const WideItem& item = plan_.items()[i];
      refs_[i] = item.is_leaf() ? write_leaf(plan_.node_bytes() + item.offset,
                                             std::span(ids).subspan(first, ends[i - begin] - first))
                                : node_ref(item.offset);
    }
  }

  void write_nodes() {
    parallel_for(refs_.size(), kItemsPerTask, threads_, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i)
        if (const WideItem& item = plan_.items()[i]; !item.is_leaf()) write_node(item);
    });
  }

  ChildRef write_leaf(size_t offset, std::span<const uint32_t> ids) {
    const size_t count = ids.size();
    auto* out = new (wide_.memory.data() + offset) float[10 * count];
    float size = 0;
    for (size_t lane = 0; lane < count; ++lane) {
      const std::array corners{mesh_.vertex(ids[lane], 0), mesh_.vertex(ids[lane], 1), mesh_.vertex(ids[lane], 2)};
      for (int axis = 0; axis < 3; ++axis) {
        const float a = corners[0][axis], b = corners[1][axis], c = corners[2][axis];
        size = std::max(size, std::max({a, b, c}) - std::min({a, b, c}));
        float* const place = out + static_cast<size_t>(axis) * count + lane;
        place[0] = a;
        place[3 * count] = b;
        place[6 * count] = c;
      }
      out[9 * count + lane] = stored_id(ids[lane]);
    }
    return leaf_ref(offset, static_cast<uint32_t>(count), std::nextafter(size, kInf));  // whatever was rounded
  }

  void write_node(const WideItem& item) {
    auto* node = new (wide_.memory.data() + item.offset) WideNode{};
    for (size_t lane = 0; lane < kWidth; ++lane) {
      const bool is_there = lane < item.children;
      const size_t child = is_there ? item.first_child + lane : 0;
      for (int axis = 0; axis < 3; ++axis) {
        const Bounds box = is_there ? plan_.bounds(plan_.items()[child]) : Bounds{};
        const float center = wide_.center[axis];
        node->lower[axis][lane] = is_there ? difference_below(box.lo[axis], center) : kInf;
        node->upper[axis][lane] = is_there ? difference_above(box.hi[axis], center) : -kInf;
      }
      if (is_there) node->child[lane] = refs_[child];
    }
  }

  const WidePlan& plan_;
  const TriangleMesh& mesh_;
  const unsigned threads_;
  std::vector<ChildRef> refs_;  // by item
  WideTree wide_;
};

}  // namespace

WideTree collapse(const Bvh& tree, const TriangleMesh& mesh, const WideOptions& options) {
  const WideForm form{kWidth, sizeof(WideNode), [](size_t count) { return count * kTriangleBytes; },
                      [&](uint32_t triangle) { return triangle_bounds(mesh, triangle); }};
  if (tree.nodes.empty()) {
    validate(options);
    return {};
  }
  const WidePlan plan(tree, options, form);
  return Collapse(plan, mesh, options.threads).run();
}

}  // namespace raygrain
