// The loops over a wide tree in ray space: nearest hit and any hit. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_FRAME_SEARCHES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_FRAME_SEARCHES_INL_H
#undef RAYGRAIN_TRACE_KERNELS_FRAME_SEARCHES_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_FRAME_SEARCHES_INL_H
#endif

#include <algorithm>
#include <bit>

#include <hwy/cache_control.h>

#include "raygrain/triangle.h"

#include "base/check.h"
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
  for (size_t i = 0; i < 4; ++i) hwy::Prefetch(lines + i * kCacheLine);
}

HWY_INLINE bool confirm(const TriangleMesh& mesh, uint32_t id, const Ray& ray, Hit& hit) {
  if (!intersect_triangle(ray, mesh.vertex(id, 0), mesh.vertex(id, 1), mesh.vertex(id, 2), hit)) return false;
  hit.triangle = id;
  return true;
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

struct FrameEntry {
  FrameRef child;
  float distance;
};

/// A child in the order of its distance, which is not below zero: the distance's bits above the child's place.
using FrameKey = uint64_t;

HWY_INLINE void order(FrameKey& a, FrameKey& b) {
  const FrameKey least = std::min(a, b);
  b = std::max(a, b);
  a = least;
}

/// Nodes and leaves that are met but not visited yet, the next one on top.
struct FrameStack {
  size_t size = 0;
  FrameEntry entries[kWideStackSize];  // NOLINT: filled as far as `size` says

  HWY_INLINE void push(const FrameMemory& tree, const FrameNode& node, FrameKey key) {
    RAYGRAIN_CHECK_LT(size, kWideStackSize);
    const FrameRef child = node.child[key & (kWidth - 1)];
    fetch(tree, child);
    entries[size].child = child;
    entries[size].distance = std::bit_cast<float>(static_cast<uint32_t>(key >> 32));
    ++size;
  }
};

/// The nearest of the children in `bits`; the others go on the stack, far ones below.
HWY_INLINE FrameRef nearest_child(const FrameMemory& tree, const FrameNode& node, const float* distance, uint32_t bits,
                                  FrameStack& stack) {
  const auto take = [&] {
    const size_t lane = take_lane(bits);
    return static_cast<FrameKey>(std::bit_cast<uint32_t>(distance[lane])) << 32 | lane;
  };
  FrameKey a = take();
  if (bits == 0) return node.child[a & (kWidth - 1)];
  FrameKey b = take();
  order(a, b);
  if (bits == 0) {
    stack.push(tree, node, b);
    return node.child[a & (kWidth - 1)];
  }
  FrameKey c = take();
  order(b, c);
  order(a, b);
  if (bits == 0) {
    stack.push(tree, node, c);
    stack.push(tree, node, b);
    return node.child[a & (kWidth - 1)];
  }
  FrameKey keys[kWidth] = {a, b, c};
  size_t count = 3;
  while (bits != 0) {
    const FrameKey key = take();
    size_t i = count++;
    for (; i > 0 && keys[i - 1] > key; --i) keys[i] = keys[i - 1];
    keys[i] = key;
  }
  while (--count > 0) stack.push(tree, node, keys[count]);
  return node.child[keys[0] & (kWidth - 1)];
}

/// Triangles that may be the nearest, until intersect_triangle has the last word; and the depth beyond which no hit
/// matters.
template <bool kCounting, bool kAscending, bool kPruning>
class FramePending {
 public:
  HWY_INLINE FramePending(const FrameMemory& tree, const FrameQuery& query, const Ray& ray, const Hit& known,
                          TraceCounters* counters)
      : mesh_(*tree.mesh),
        query_(query),
        ray_(ray),
        along_(query),
        best_(known),
        counters_(counters),
        bound_(kAscending ? query.column.box.hi.z : query.column.box.lo.z),
        distance_(along_.distance(bound_)) {}

  HWY_INLINE float bound() const { return bound_; }
  HWY_INLINE float distance() const { return distance_; }
  HWY_INLINE const Along<kAscending>& along() const { return along_; }

  HWY_INLINE void add(uint32_t id, float first, float last, bool sure) {
    if (size_ == kCapacity) decide();
    hwy::Prefetch(&mesh_.triangles[id]);
    entries_[size_++] = {id, first, last};
    if (sure) lower(first, last);
  }
  /// Decides all of them.
  void decide() {
    while (size_ > 0) {
      const Candidate& next = entries_[--size_];
      if (kPruning && is_beyond(next.first, next.last)) continue;
      if constexpr (kCounting) ++counters_->triangle_tests;
      Hit hit;
      if (!confirm(mesh_, next.id, ray_, hit) || !is_nearer(hit, best_)) continue;
      best_ = hit;
      lower(next.first, next.last);
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

  HWY_INLINE void lower(float first, float last) {
    if (!kPruning) return;
    const float bound = query_.bound_after(first, last);
    bound_ = kAscending ? std::min(bound_, bound) : std::max(bound_, bound);
    distance_ = along_.distance(bound_);
  }

  const TriangleMesh& mesh_;
  const FrameQuery& query_;
  const Ray& ray_;
  Along<kAscending> along_;
  Hit best_;
  TraceCounters* counters_;
  float bound_, distance_;
  size_t size_ = 0;
  Candidate entries_[kCapacity];  // NOLINT: filled as far as size_ says
};

template <class Boxes, class Triangles, bool kAscending, bool kCounting, bool kPruning>
Hit nearest_in_frame(const FrameMemory& tree, const FrameQuery& query, const Ray& ray, const Hit& known,
                     TraceCounters* counters) {
  const Boxes boxes(query);
  const Triangles triangles(tree, query);
  FramePending<kCounting, kAscending, kPruning> pending(tree, query, ray, known, counters);
  FrameStack stack;
  FrameRef current = frame_ref(0, 0);
  while (true) {
    if (triangles_of(current) == 0) {
      const FrameNode& node = tree.node(current);
      count_node<kCounting>(node, counters);
      alignas(32) float distance[kWidth];
      const uint32_t bits = boxes(node, pending.bound(), pending.along(), distance);
      if (bits != 0) {
        current = nearest_child(tree, node, distance, bits, stack);
        continue;
      }
    } else {
      const FrameLeaf leaf = tree.leaf(current);
      count_leaf<kCounting>(current, counters);
      FrameCandidates found;
      uint32_t bits = triangles(leaf, kAscending ? query.column.box.lo.z : pending.bound(),
                                kAscending ? pending.bound() : query.column.box.hi.z, found);
      if (bits != 0) {
        alignas(32) float first[kWidth], last[kWidth];
        store(found.first, first);
        store(found.last, last);
        do {
          const size_t lane = take_lane(bits);
          if (kPruning && pending.is_beyond(first[lane], last[lane])) continue;
          pending.add(leaf.id(lane), first[lane], last[lane], (found.sure >> lane & 1) != 0);
        } while (bits != 0);
      }
    }
    do {
      if (stack.size == 0) {
        pending.decide();
        return pending.best();
      }
      --stack.size;
    } while (stack.entries[stack.size].distance > pending.distance());
    current = stack.entries[stack.size].child;
  }
}

template <class Boxes, class Triangles, bool kCounting, bool kPruning>
bool any_in_frame(const FrameMemory& tree, const FrameQuery& query, const Ray& ray, TraceCounters* counters) {
  const Boxes boxes(query);
  const Triangles triangles(tree, query);
  const float lo = query.column.box.lo.z, hi = query.column.box.hi.z;
  bool hit_something = false;
  size_t size = 0;
  FrameRef stack[kWideStackSize];  // NOLINT: filled as far as `size` says
  FrameRef current = frame_ref(0, 0);
  while (true) {
    if (triangles_of(current) == 0) {
      const FrameNode& node = tree.node(current);
      count_node<kCounting>(node, counters);
      uint32_t bits = boxes(node);
      if (bits != 0) {
        current = node.child[take_lane(bits)];
        while (bits != 0) {
          const auto lane = static_cast<size_t>(31 - std::countl_zero(bits));
          bits ^= 1u << lane;
          fetch(tree, node.child[lane]);
          RAYGRAIN_CHECK_LT(size, kWideStackSize);
          stack[size++] = node.child[lane];
        }
        continue;
      }
    } else {
      const FrameLeaf leaf = tree.leaf(current);
      count_leaf<kCounting>(current, counters);
      FrameCandidates found;
      uint32_t bits = triangles(leaf, lo, hi, found);
      if (bits != 0 && found.sure != 0) {
        if (kPruning) return true;
        hit_something = true;
      }
      while (bits != 0) {
        const size_t lane = take_lane(bits);
        if constexpr (kCounting) ++counters->triangle_tests;
        Hit hit;
        if (!confirm(*tree.mesh, leaf.id(lane), ray, hit)) continue;
        if (kPruning) return true;
        hit_something = true;
      }
    }
    if (size == 0) return hit_something;
    current = stack[--size];
  }
}

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
