// Searches for many rays at once: several are in flight, and in each round each takes a step, so that one ray's waits
// for memory and for long chains of instructions are filled with the others' work. Steps have no branches that are hard
// to predict: what would be skipped is computed and not used. Every ray finds what it finds alone. Needs vectors of
// eight floats (kHasStreams). Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_STREAMS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_STREAMS_INL_H
#undef RAYGRAIN_TRACE_KERNELS_STREAMS_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_STREAMS_INL_H
#endif

#include <algorithm>
#include <bit>

#include "trace/kernels/compress-inl.h"
#include "trace/kernels/searches-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

using KeyTag = hn::RebindToUnsigned<Tag>;
constexpr bool kHasStreams = HWY_TARGET <= HWY_AVX2;  // or better

/// Rays in flight: enough to fill the waits, few enough to stay in the first cache.
constexpr size_t kSlots = 16;

/// In place of a child: the search has ended.
constexpr ChildRef kDone = 15;
static_assert(kDone > kWidth);

/// What is met but not visited yet, the next on top, upon eight entries that say that the search has ended. Vectors are
/// written whole: what is above `size` means nothing.
struct StreamStack {
  static constexpr size_t kCapacity = kWideStackSize + 2 * kWidth;

  size_t size;
  float entry[kCapacity];
  ChildRef child[kCapacity];

  void prepare() {
    std::fill_n(entry, kWidth, -kInf);
    std::fill_n(child, kWidth, kDone);
    clear();
  }
  void clear() { size = kWidth; }
};

HWY_INLINE hn::Mask<Tag> mask_of(uint32_t bits) {
  return mask_of(Tag(), bits);
}

/// The least of those in `bits`; infinity without any.
HWY_INLINE float least_of(const float* values, uint32_t bits) {
  const Tag tag;
  return hn::GetLane(hn::MinOfLanes(tag, hn::IfThenElse(mask_of(bits), hn::Load(tag, values), hn::Set(tag, kInf))));
}

/// Puts the children in `bits` on the stack, the last lane on top, without making it larger.
HWY_INLINE void store_children(StreamStack& stack, const WideNode& node, uint32_t bits) {
#if HWY_TARGET <= HWY_AVX3
  const hn::CappedTag<ChildRef, kWidth> refs;
  const KeyTag tag;
  const auto lanes = hn::PromoteTo(refs, hn::Compress(hn::Iota(tag, 0), hn::RebindMask(tag, mask_of(bits))));
  const auto children = hn::TableLookupLanes(hn::Load(refs, node.child), hn::IndicesFromVec(refs, lanes));
  hn::StoreU(children, refs, stack.child + stack.size);
#else
  ChildRef* const top = stack.child + stack.size;
  for (size_t i = 0; i < kWidth; ++i) top[i] = node.child[kLaneLists.of[bits][i]];
#endif
}

/// The same with where they begin.
HWY_INLINE void store_entries(StreamStack& stack, hn::Vec<Tag> enter, uint32_t bits) {
  hn::StoreU(compressed(Tag(), enter, mask_of(bits)), Tag(), stack.entry + stack.size);
}

/// One of two numbers without a branch.
HWY_INLINE uint64_t choose(bool first, uint64_t a, uint64_t b) {
  const uint64_t mask = 0 - static_cast<uint64_t>(first);
  return (a & mask) | (b & ~mask);
}

/// Runs a search for many rays. `Search` has a type Slot with members `current` and `stack`, and
///   bool start(Slot&)        takes the next ray; false when there is none
///   void visit_node(Slot&)   one step each
///   void visit_leaf(Slot&)
///   void finish(Slot&)       keeps the answer
template <class Search>
class Stream {
 public:
  explicit Stream(Search& search) : search_(search) {}

  void run() {
    for (Slot& slot : slots_) {
      slot.stack.prepare();
      if (search_.start(slot)) put(&slot);
    }
    while (nodes_ + leaves_ + done_ > 0) {
      Slot* active[kSlots];
      size_t count = 0;
      for (size_t i = 0; i < nodes_; ++i) search_.visit_node(*(active[count++] = at_node_[i]));
      for (size_t i = 0; i < leaves_; ++i) search_.visit_leaf(*(active[count++] = at_leaf_[i]));
      for (size_t i = 0; i < done_; ++i) {
        search_.finish(*finished_[i]);
        active[count] = finished_[i];
        if (search_.start(*finished_[i])) ++count;
      }
      nodes_ = leaves_ = done_ = 0;
      for (size_t i = 0; i < count; ++i) put(active[i]);
    }
  }

 private:
  using Slot = typename Search::Slot;

  /// Into the list of what it does next, without a branch.
  HWY_INLINE void put(Slot* slot) {
    const uint32_t kind = triangles_of(slot->current);
    at_node_[nodes_] = at_leaf_[leaves_] = finished_[done_] = slot;
    nodes_ += kind == 0;
    leaves_ += kind - 1 < kWidth;
    done_ += kind == kDone;
  }

  Search& search_;
  Slot slots_[kSlots];
  size_t nodes_ = 0, leaves_ = 0, done_ = 0;
  Slot *at_node_[kSlots + 1], *at_leaf_[kSlots + 1], *finished_[kSlots + 1];
};

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
