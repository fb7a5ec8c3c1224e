// Chosen lanes of a vector, moved together. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_COMPRESS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_COMPRESS_INL_H
#undef RAYGRAIN_TRACE_KERNELS_COMPRESS_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_COMPRESS_INL_H
#endif

#include <hwy/highway.h>

#include "trace/kernels/masks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// For every set of eight lanes its lanes, the lowest first, and then any.
struct LaneLists {
  uint8_t of[256][8] = {};

  constexpr LaneLists() {
    for (uint32_t bits = 0; bits < 256; ++bits)
      for (uint32_t lane = 0, count = 0; lane < 8; ++lane)
        if ((bits >> lane & 1) != 0) of[bits][count++] = static_cast<uint8_t>(lane);
  }
};
constexpr LaneLists kLaneLists;

/// The lanes in the mask in their order, and then any; lanes of 32 bits. But for AVX-512, whose instruction it is, not
/// by Highway's Compress: GCC copies its tables onto the stack at each call.
template <class LaneTag>
HWY_INLINE hn::Vec<LaneTag> compressed(LaneTag tag, hn::Vec<LaneTag> lanes, hn::Mask<LaneTag> mask) {
#if HWY_TARGET <= HWY_AVX3  // or better
  static_cast<void>(tag);
  return hn::Compress(lanes, mask);
#else
  static_assert(hn::MaxLanes(LaneTag()) <= 8);
  const hn::Rebind<uint8_t, LaneTag> bytes;
  const auto places =
      hn::PromoteTo(hn::RebindToUnsigned<LaneTag>(), hn::LoadU(bytes, kLaneLists.of[bits_of(tag, mask)]));
  return hn::TableLookupLanes(lanes, hn::IndicesFromVec(tag, places));
#endif
}

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
