// Masks of vectors of up to eight lanes as bits of an integer. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_MASKS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_MASKS_INL_H
#undef RAYGRAIN_TRACE_KERNELS_MASKS_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_MASKS_INL_H
#endif

#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

/// Bit i: lane i.
template <class LaneTag>
HWY_INLINE uint32_t bits_of(LaneTag tag, hwy::HWY_NAMESPACE::Mask<LaneTag> mask) {
  uint8_t bytes[8] = {};
  hwy::HWY_NAMESPACE::StoreMaskBits(tag, mask, bytes);
  return bytes[0];
}
template <class LaneTag>
HWY_INLINE hwy::HWY_NAMESPACE::Mask<LaneTag> mask_of(LaneTag tag, uint32_t bits) {
  const uint8_t bytes[8] = {static_cast<uint8_t>(bits)};
  return hwy::HWY_NAMESPACE::LoadMaskBits(tag, bytes);
}

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
