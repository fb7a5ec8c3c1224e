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

#include "base/check.h"
#include "trace/careful.h"
#include "trace/kernels/filters-inl.h"
#include "trace/kernels/pending-inl.h"

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

/// kPruning = false visits everything that the ray meets within its own interval.
template <bool kCounting, bool kPruning>
Hit nearest(const WideTree& tree, const Ray& ray, const Hit& known, float skip_before, TraceCounters* counters) {
  BoxFilter<Eight> boxes;
  if (!(ray.tmin <= ray.tmax)) return known;
  if (!boxes.prepare(tree, ray, skip_before)) [[unlikely]]
    return is_valid(ray) ? nearest_carefully(tree, ray, known, {skip_before, kPruning}, counters) : known;
  TriangleFilter<Eight> triangles;
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
        const float lowered = pending.template add<kPruning>(leaf, size_of(current), found, bound);
        if (kPruning) bound = lowered;
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
  BoxFilter<Eight> boxes;
  if (!(ray.tmin <= ray.tmax)) return false;
  if (!boxes.prepare(tree, ray, skip_before)) [[unlikely]]
    return is_valid(ray) && any_carefully(tree, ray, {skip_before, kPruning}, counters);
  TriangleFilter<Eight> triangles;
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
      const AnyHits found = meet_any<true>(triangles.pairs(leaf, current, ray.tmax));
      if (kPruning && found.sure != 0) return true;
      hit_something |= found.sure != 0;
      for (uint32_t bits = found.possible & ~found.sure; bits != 0;) {
        if constexpr (kCounting) ++counters->triangle_tests;
        Hit hit;
        if (!confirm(leaf, take_lowest(bits), ray, hit)) continue;
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
