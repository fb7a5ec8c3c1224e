// The loops over a wide tree: nearest hit and any hit. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_SEARCHES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_SEARCHES_INL_H
#undef RAYGRAIN_TRACE_KERNELS_SEARCHES_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_SEARCHES_INL_H
#endif

#include <algorithm>
#include <bit>
#include <utility>

#include <hwy/cache_control.h>

#include "raygrain/triangle.h"

#include "base/check.h"
#include "trace/careful.h"
#include "trace/kernels/confirm-inl.h"
#include "trace/kernels/filters-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

struct Entry {
  ChildRef child;
  float entry;
};

/// Nodes and leaves that are met but not visited yet, the next one on top.
struct Stack {
  size_t size = 0;
  Entry entries[kWideStackSize];  // NOLINT: filled as far as `size` says

  HWY_INLINE void push(ChildRef child, float entry) {
    RAYGRAIN_CHECK_LT(size, kWideStackSize);
    entries[size].child = child;
    entries[size].entry = entry;
    ++size;
  }
};

HWY_INLINE size_t take_lowest(uint32_t& bits) {
  const auto lane = static_cast<size_t>(std::countr_zero(bits));
  bits &= bits - 1;
  return lane;
}

/// A child that the ray meets, in the order of its entry: the entry's bits above the child's number. Entries below zero
/// come in the wrong order, which costs time at most.
using Key = uint64_t;

HWY_INLINE Key key_of(const float* entry, size_t lane) {
  return static_cast<Key>(std::bit_cast<uint32_t>(entry[lane])) << 32 | lane;
}
HWY_INLINE void sort(Key& a, Key& b) {
  const Key swap = (a ^ b) & (0 - static_cast<Key>(b < a));  // no branch: it would be hard to predict
  a ^= swap;
  b ^= swap;
}
HWY_INLINE void fetch(const WideTree& tree, ChildRef child) {
  const std::byte* lines = tree.memory.data() + (child >> 20);
  hwy::Prefetch(lines);
  hwy::Prefetch(lines + kCacheLine);
  hwy::Prefetch(lines + 2 * kCacheLine);
  hwy::Prefetch(lines + 3 * kCacheLine);
}

HWY_INLINE void push(Stack& stack, const WideTree& tree, const WideNode& node, Key key) {
  const ChildRef child = node.child[key & (kWidth - 1)];
  fetch(tree, child);
  stack.push(child, std::bit_cast<float>(static_cast<uint32_t>(key >> 32)));
}

HWY_INLINE bool confirm(const WideLeaf& leaf, size_t lane, const Ray& ray, Hit& hit) {
  if (!intersect_triangle(ray, leaf.vertex(0, lane), leaf.vertex(1, lane), leaf.vertex(2, lane), hit)) return false;
  hit.triangle = leaf.id(lane);
  return true;
}

/// The nearest of the children in `bits`; the others go on the stack, far ones below.
HWY_INLINE ChildRef nearest_child(const WideTree& tree, const WideNode& node, const float* entry, uint32_t bits,
                                  Stack& stack) {
  size_t lane = take_lowest(bits);
  if (bits == 0) return node.child[lane];
  Key a = key_of(entry, lane), b = key_of(entry, take_lowest(bits));
  sort(a, b);
  if (bits == 0) {
    push(stack, tree, node, b);
    return node.child[a & (kWidth - 1)];
  }
  Key c = key_of(entry, take_lowest(bits));
  sort(b, c);
  sort(a, b);
  if (bits == 0) {
    push(stack, tree, node, c);
    push(stack, tree, node, b);
    return node.child[a & (kWidth - 1)];
  }
  Key d = key_of(entry, take_lowest(bits));
  sort(c, d);
  sort(b, c);
  sort(a, b);
  const size_t base = stack.size;
  while (bits != 0) {  // five and more: the farthest so far goes into the sorted ones on the stack
    push(stack, tree, node, d);
    for (size_t i = stack.size - 1; i > base && stack.entries[i - 1].entry < stack.entries[i].entry; --i) {
      std::swap(stack.entries[i - 1].child, stack.entries[i].child);
      std::swap(stack.entries[i - 1].entry, stack.entries[i].entry);
    }
    d = key_of(entry, take_lowest(bits));
    sort(c, d);
    sort(b, c);
    sort(a, b);
  }
  push(stack, tree, node, d);
  push(stack, tree, node, c);
  push(stack, tree, node, b);
  return node.child[a & (kWidth - 1)];
}

template <bool kCounting>
HWY_INLINE void count_node(const WideNode& node, TraceCounters* counters) {
  if constexpr (kCounting) {
    ++counters->inner_hits;
    for (const ChildRef child : node.child) counters->box_tests += child != 0;
  }
}

template <bool kCounting>
HWY_INLINE void count_leaf(ChildRef leaf, TraceCounters* counters) {
  if constexpr (kCounting) {
    ++counters->leaf_hits;
    counters->leaf_triangles += triangles_of(leaf);
  }
}

/// Leaves with triangles that may be the nearest, until double precision has the last word.
template <bool kCounting>
class Pending {
 public:
  Pending() = default;
  HWY_INLINE Pending(const Ray& ray, const Hit& known, TraceCounters* counters)
      : ray_(&ray), best_(known), counters_(counters) {}
  HWY_INLINE void start(const Ray& ray) {
    ray_ = &ray;
    best_ = {};
    size_ = 0;
  }

  /// What the filter found in a leaf. Returns the new bound: no hit beyond it matters.
  template <bool kPruning>
  HWY_INLINE float add(const WideLeaf& leaf, float size, const Candidates& found, float bound) {
    float earliest = kInf;
    for (uint32_t bits = found.possible; bits != 0;) {
      const size_t lane = take_lowest(bits);
      earliest = std::min(earliest, found.earliest[lane]);
      if (kPruning && (found.sure >> lane & 1) != 0) bound = std::min(bound, found.latest[lane]);
    }
    if (size_ == kCapacity) bound = decide_apart(bound);
    entries_[size_++] = {leaf.bytes, leaf.count, found.possible, found.sure, size, earliest};
    return bound;
  }
  /// Decides all of them; no hit beyond `bound` matters. Returns the new bound.
  HWY_INLINE float decide(float bound) {
    while (size_ > 0) {  // the last one first: it is the nearest most often
      const Entry& next = entries_[--size_];
      if (next.earliest > bound) continue;
      if constexpr (kCounting) counters_->triangle_tests += static_cast<uint64_t>(std::popcount(next.lanes));
      decide(next);
      bound = std::min(bound, best_.t);
    }
    return bound;
  }
  const Hit& best() const { return best_; }

 private:
  struct Entry {
    const std::byte* bytes;  // of the leaf
    uint32_t count, lanes, sure;
    float size, earliest;
  };
  static constexpr size_t kCapacity = 16;

  HWY_NOINLINE float decide_apart(float bound) { return decide(bound); }

  HWY_INLINE void decide(const Entry& entry) {
    if ((entry.lanes & ~entry.sure) != 0)
      decide_unsure(entry);
    else
      decide<true>(entry);
  }
  HWY_NOINLINE void decide_unsure(const Entry& entry) { decide<false>(entry); }

  template <bool kSure>
  HWY_INLINE void decide(const Entry& entry) {
    const WideLeaf leaf{entry.bytes, entry.count};
    for (size_t first = 0; first < kWidth; first += kDoubles) {
      const uint32_t lanes = entry.lanes >> first & ((1u << kDoubles) - 1);
      if (lanes == 0) continue;
      Verdicts verdicts;
      confirm<kSure>(*ray_, leaf, entry.size, first, verdicts);
      for (uint32_t hits = verdicts.hit & lanes; hits != 0;) {
        const size_t i = take_lowest(hits);
        take({verdicts.t[i], verdicts.u[i], verdicts.v[i], leaf.id(first + i)});
      }
      if ((verdicts.unsure & lanes) != 0) [[unlikely]]
        decide_alone(leaf, (verdicts.unsure & lanes) << first);
    }
  }
  HWY_NOINLINE void decide_alone(const WideLeaf& leaf, uint32_t lanes) {
    while (lanes != 0) {
      Hit hit;
      if (confirm(leaf, take_lowest(lanes), *ray_, hit)) take(hit);
    }
  }
  HWY_INLINE void take(const Hit& hit) {
    if (is_nearer(hit, best_)) best_ = hit;
  }

  const Ray* ray_ = nullptr;
  Hit best_;
  TraceCounters* counters_ = nullptr;
  size_t size_ = 0;
  Entry entries_[kCapacity];  // NOLINT: filled as far as size_ says
};

/// kPruning = false visits everything that the ray meets within its own interval.
template <bool kCounting, bool kPruning>
Hit nearest(const WideTree& tree, const Ray& ray, const Hit& known, float skip_before, TraceCounters* counters) {
  BoxFilter boxes;
  if (!(ray.tmin <= ray.tmax)) return known;
  if (!boxes.prepare(tree, ray, skip_before)) [[unlikely]]
    return is_valid(ray) ? nearest_carefully(tree, ray, known, {skip_before, kPruning}, counters) : known;
  TriangleFilter triangles;
  triangles.prepare(ray);
  Pending<kCounting> pending(ray, known, counters);
  float bound = kPruning ? std::min(ray.tmax, known.t) : ray.tmax;
  Stack stack;
  ChildRef current = node_ref(0);
  while (true) {
    if (triangles_of(current) == 0) {
      const WideNode& node = tree.node(current);
      count_node<kCounting>(node, counters);
      alignas(32) float entry[kWidth];
      uint32_t bits = boxes(node, bound, entry);
      if (bits != 0) {
        current = nearest_child(tree, node, entry, bits, stack);
        continue;
      }
    } else {
      const WideLeaf leaf = tree.leaf(current);
      count_leaf<kCounting>(current, counters);
      Candidates found;
      uint32_t bits = triangles.test<true>(leaf, current, bound, found);
      if (bits != 0) {
        bound = pending.template add<kPruning>(leaf, size_of(current), found, bound);
      }
    }
    do {
      if (stack.size == 0) {
        pending.decide(kPruning ? bound : kInf);
        return pending.best();
      }
      --stack.size;
    } while (stack.entries[stack.size].entry > bound);
    current = stack.entries[stack.size].child;
  }
}

template <bool kCounting, bool kPruning>
bool any(const WideTree& tree, const Ray& ray, float skip_before, TraceCounters* counters) {
  BoxFilter boxes;
  if (!(ray.tmin <= ray.tmax)) return false;
  if (!boxes.prepare(tree, ray, skip_before)) [[unlikely]]
    return is_valid(ray) && any_carefully(tree, ray, {skip_before, kPruning}, counters);
  TriangleFilter triangles;
  triangles.prepare(ray);
  bool hit_something = false;
  Stack stack;
  ChildRef current = node_ref(0);
  while (true) {
    if (triangles_of(current) == 0) {
      const WideNode& node = tree.node(current);
      count_node<kCounting>(node, counters);
      alignas(32) float entry[kWidth];
      uint32_t bits = boxes(node, ray.tmax, entry);
      if (bits != 0) {
        const auto last = static_cast<size_t>(31 - std::countl_zero(bits));  // the most probable
        bits ^= 1u << last;
        while (bits != 0) {
          const ChildRef child = node.child[take_lowest(bits)];
          fetch(tree, child);
          stack.push(child, 0);
        }
        current = node.child[last];
        continue;
      }
    } else {
      const WideLeaf leaf = tree.leaf(current);
      count_leaf<kCounting>(current, counters);
      Candidates found;
      uint32_t bits = triangles.test<true>(leaf, current, ray.tmax, found);
      while (bits != 0) {
        const size_t lane = take_lowest(bits);
        const bool is_sure = (found.sure >> lane & 1) != 0 && found.latest[lane] <= ray.tmax;
        if (!is_sure) {
          if constexpr (kCounting) ++counters->triangle_tests;
          Hit hit;
          if (!confirm(leaf, lane, ray, hit)) continue;
        }
        if (kPruning) return true;
        hit_something = true;
      }
    }
    if (stack.size == 0) return hit_something;
    current = stack.entries[--stack.size].child;
  }
}

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
