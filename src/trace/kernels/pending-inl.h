// Triangles that float filters leave to be decided, for one ray. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_PENDING_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_PENDING_INL_H
#undef RAYGRAIN_TRACE_KERNELS_PENDING_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_PENDING_INL_H
#endif

#include <algorithm>
#include <bit>

#include "raygrain/trace.h"
#include "raygrain/triangle.h"

#include "trace/kernels/confirm-inl.h"
#include "trace/kernels/filters-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

HWY_INLINE size_t take_lowest(uint32_t& bits) {
  const auto lane = static_cast<size_t>(std::countr_zero(bits));
  bits &= bits - 1;
  return lane;
}

HWY_INLINE bool confirm(const WideLeaf& leaf, size_t lane, const Ray& ray, Hit& hit) {
  if (!intersect_triangle(ray, leaf.vertex(0, lane), leaf.vertex(1, lane), leaf.vertex(2, lane), hit)) return false;
  hit.triangle = leaf.id(lane);
  return true;
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
    const bool is_one = (found.possible & (found.possible - 1)) == 0;
    const uint32_t lanes = kPruning && !is_one ? not_behind(found, bound) : found.possible;
    if (size_ == kCapacity) bound = decide_apart(bound);
    entries_[size_++] = {leaf.bytes, leaf.count, lanes, found.sure, size, earliest};
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

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
