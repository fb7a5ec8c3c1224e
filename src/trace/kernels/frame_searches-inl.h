// The loops over a wide tree in ray space: nearest hit and any hit. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_FRAME_SEARCHES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_FRAME_SEARCHES_INL_H
#undef RAYGRAIN_TRACE_KERNELS_FRAME_SEARCHES_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_FRAME_SEARCHES_INL_H
#endif

#include <algorithm>
#include <bit>
#include <utility>

#include <hwy/cache_control.h>

#include "raygrain/triangle.h"

#include "base/check.h"
#include "trace/kernels/compress-inl.h"
#include "trace/kernels/frame_filters-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

HWY_INLINE size_t take_lane(uint32_t& bits) {
  const auto lane = static_cast<size_t>(std::countr_zero(bits));
  bits &= bits - 1;
  return lane;
}

HWY_INLINE void fetch(const FrameMemory& tree, FrameRef child) {
  const std::byte* lines = tree.at(child);
  for (size_t i = 0; i < 7; ++i) hwy::Prefetch(lines + i * kCacheLine);
}

HWY_INLINE bool confirm(const FrameMemory& tree, uint32_t id, const Ray& ray, Hit& hit) {
  const std::array<Vec3, 3>& corners = tree.corners->at_id(id);
  if (!intersect_triangle(ray, corners[0], corners[1], corners[2], hit)) return false;
  hit.triangle = id;
  return true;
}

HWY_INLINE void fetch_corners(const FrameMemory& tree, uint32_t id) {
  const auto* first = reinterpret_cast<const std::byte*>(&tree.corners->at_id(id));
  hwy::Prefetch(first);
  hwy::Prefetch(first + sizeof(std::array<Vec3, 3>) - 1);
}

template <bool kCounting>
HWY_INLINE void count_node(const FrameNode& node, TraceCounters* counters) {
  if constexpr (kCounting) {
    ++counters->inner_hits;
    for (const FrameRef child : node.child) counters->box_tests += child != 0;
  }
}
template <bool kCounting>
HWY_INLINE void count_leaf(FrameRef leaf, TraceCounters* counters) {
  if constexpr (kCounting) {
    ++counters->leaf_hits;
    counters->leaf_triangles += triangles_of(leaf);
  }
}

/// Nodes and leaves that are met but not visited yet, the next one on top. Children lie in a node in the order of their
/// depths, so they need no sorting.
struct FrameStack {
  size_t size = 0;
  alignas(64) FrameRef refs[kFrameStackSize];  // NOLINT: filled as far as `size` says

  template <class Mask>
  HWY_INLINE void push(const FrameNode& node, size_t at, Mask mask) {
    RAYGRAIN_CHECK_LT(size, kFrameStackSize - kFrameWidth);
    const FrameRefTag tag;
    const auto children = hn::Load(tag, node.child + at);
    const auto bits = hn::RebindMask(tag, mask);
    hn::StoreU(compressed(tag, children, bits), tag, refs + size);
    size += hn::CountTrue(tag, bits);
  }
};

/// The same with the depth at which each is entered.
struct OrderedStack : FrameStack {
  alignas(64) float depths[kFrameStackSize];  // NOLINT

  template <bool kAscending, class Mask>
  HWY_INLINE void push(const FrameNode& node, size_t at, Mask mask) {
    const FrameTag tag;
    const float* sides = (kAscending ? node.lower[2] : node.upper[2]) + at;
    hn::StoreU(compressed(tag, hn::Load(tag, sides), mask), tag, depths + size);
    FrameStack::push(node, at, mask);
  }
  /// Rays that run against the order of the node.
  HWY_INLINE void reverse(size_t from) {
    for (size_t a = from, b = size; a + 1 < b; ++a) {
      --b;
      std::swap(refs[a], refs[b]);
      std::swap(depths[a], depths[b]);
    }
  }
};

/// Triangles that may be the nearest, until intersect_triangle has the last word; and the depth beyond which no hit
/// matters.
template <bool kCounting, bool kAscending, bool kPruning>
class FramePending {
 public:
  HWY_INLINE FramePending(const FrameMemory& tree, const FrameQuery& query, const Ray& ray, const Hit& known,
                          TraceCounters* counters)
      : tree_(tree),
        query_(query),
        ray_(ray),
        best_(known),
        counters_(counters),
        bound_(kAscending ? query.column.box.hi.z : query.column.box.lo.z) {}

  HWY_INLINE float bound() const { return bound_; }

  HWY_INLINE void add(uint32_t id, float first, float last, bool sure) {
    if (size_ == kCapacity) decide();
    fetch_corners(tree_, id);
    entries_[size_++] = {id, first, last};
    if (sure) lower(query_.bound_after(first, last));
  }
  /// Decides all of them.
  void decide() {
    while (size_ > 0) {
      const Candidate& next = entries_[--size_];
      if (kPruning && is_beyond(next.first, next.last)) continue;
      if constexpr (kCounting) ++counters_->triangle_tests;
      Hit hit;
      if (!confirm(tree_, next.id, ray_, hit) || !is_nearer(hit, best_)) continue;
      best_ = hit;
      lower(query_.bound_at(hit.t));
    }
  }
  HWY_INLINE bool is_beyond(float first, float last) const { return kAscending ? first > bound_ : last < bound_; }
  const Hit& best() const { return best_; }

 private:
  struct Candidate {
    uint32_t id;
    float first, last;
  };
  static constexpr size_t kCapacity = 16;

  HWY_INLINE void lower(float bound) {
    if (!kPruning) return;
    bound_ = kAscending ? std::min(bound_, bound) : std::max(bound_, bound);
  }

  const FrameMemory& tree_;
  const FrameQuery& query_;
  const Ray& ray_;
  Hit best_;
  TraceCounters* counters_;
  float bound_;
  size_t size_ = 0;
  Candidate entries_[kCapacity];  // NOLINT: filled as far as size_ says
};

template <class Boxes, class Triangles, bool kAscending, bool kCounting, bool kPruning>
Hit nearest_in_frame(const FrameMemory& tree, const FrameQuery& query, const Ray& ray, const Hit& known,
                     TraceCounters* counters) {
  const Boxes boxes(query);
  const Triangles triangles(tree, query);
  const float start = kAscending ? query.column.box.lo.z : query.column.box.hi.z;
  FramePending<kCounting, kAscending, kPruning> pending(tree, query, ray, known, counters);
  OrderedStack stack;
  FrameRef current = frame_ref(0, 0);
  while (true) {
    const float bound = pending.bound(), lo = kAscending ? start : bound, hi = kAscending ? bound : start;
    if (triangles_of(current) == 0) {
      const FrameNode& node = tree.node(current);
      count_node<kCounting>(node, counters);
      const FrameVec first = all(lo), last = all(hi);
      const size_t size = stack.size;
      for (size_t at = 0; at < kFrameWidth; at += kFrameLanes)
        stack.template push<kAscending>(node, at, boxes(node, at, first, last));
      if (!kAscending) stack.reverse(size);
    } else {
      const FrameLeaf leaf = tree.leaf(current);
      count_leaf<kCounting>(current, counters);
      for (size_t at = 0; at < leaf.count; at += kFrameLanes) {
        FrameCandidates found;
        uint32_t bits = triangles({leaf, at}, all(lo), all(hi), found);
        if (bits == 0) continue;
        alignas(64) float nearest[kFrameLanes], farthest[kFrameLanes];
        hn::Store(found.first, FrameTag(), nearest);
        hn::Store(found.last, FrameTag(), farthest);
        do {
          const size_t lane = take_lane(bits);
          if (kPruning && pending.is_beyond(nearest[lane], farthest[lane])) continue;
          pending.add(leaf.id(at + lane), nearest[lane], farthest[lane], (found.sure >> lane & 1) != 0);
        } while (bits != 0);
      }
    }
    do {
      if (stack.size == 0) {
        pending.decide();
        return pending.best();
      }
      --stack.size;
    } while (pending.is_beyond(stack.depths[stack.size], stack.depths[stack.size]));
    current = stack.refs[stack.size];
    if (stack.size != 0) fetch(tree, stack.refs[stack.size - 1]);
  }
}

template <class Boxes, class Triangles, bool kCounting, bool kPruning>
bool any_in_frame(const FrameMemory& tree, const FrameQuery& query, const Ray& ray, TraceCounters* counters) {
  const Boxes boxes(query);
  const Triangles triangles(tree, query);
  const float lo = query.column.box.lo.z, hi = query.column.box.hi.z;
  const FrameVec first = all(lo), last = all(hi);
  bool hit_something = false;
  FrameStack stack;
  FrameRef current = frame_ref(0, 0);
  while (true) {
    if (triangles_of(current) == 0) {
      const FrameNode& node = tree.node(current);
      count_node<kCounting>(node, counters);
      for (size_t at = 0; at < kFrameWidth; at += kFrameLanes) stack.push(node, at, boxes(node, at, first, last));
    } else {
      const FrameLeaf leaf = tree.leaf(current);
      count_leaf<kCounting>(current, counters);
      for (size_t at = 0; at < leaf.count; at += kFrameLanes) {
        FrameCandidates found;
        uint32_t bits = triangles({leaf, at}, first, last, found);
        if (bits == 0) continue;
        if (found.sure != 0) {
          if (kPruning) return true;
          hit_something = true;
        }
        do {
          const size_t lane = take_lane(bits);
          if constexpr (kCounting) ++counters->triangle_tests;
          Hit hit;
          if (!confirm(tree, leaf.id(at + lane), ray, hit)) continue;
          if (kPruning) return true;
          hit_something = true;
        } while (bits != 0);
      }
    }
    if (stack.size == 0) return hit_something;
    current = stack.refs[--stack.size];
    if (stack.size != 0) fetch(tree, stack.refs[stack.size - 1]);
  }
}

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
