// Eight floats in as many vectors as the instruction set needs. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_EIGHT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_EIGHT_INL_H
#undef RAYGRAIN_TRACE_KERNELS_EIGHT_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_EIGHT_INL_H
#endif

#include <hwy/highway.h>

#include "trace/kernels/masks-inl.h"
#include "trace/wide_tree.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, 8>;
constexpr size_t kLanes = hn::MaxLanes(Tag());
constexpr size_t kParts = 8 / kLanes;

struct Eight {
  hn::Vec<Tag> part[kParts];
};

HWY_INLINE Eight broadcast(float x) {
  Eight r;
  for (size_t i = 0; i < kParts; ++i) r.part[i] = hn::Set(Tag(), x);
  return r;
}
HWY_INLINE Eight broadcast(const Eight& x) {
  return x;
}
HWY_INLINE Eight load(const float* from) {
  Eight r;
  for (size_t i = 0; i < kParts; ++i) r.part[i] = hn::Load(Tag(), from + i * kLanes);
  return r;
}
HWY_INLINE Eight load_unaligned(const float* from) {
  Eight r;
  for (size_t i = 0; i < kParts; ++i) r.part[i] = hn::LoadU(Tag(), from + i * kLanes);
  return r;
}
HWY_INLINE void store(const Eight& a, float* to) {
  for (size_t i = 0; i < kParts; ++i) hn::Store(a.part[i], Tag(), to + i * kLanes);
}
HWY_INLINE Eight operator+(const Eight& a, const Eight& b) {
  Eight r;
  for (size_t i = 0; i < kParts; ++i) r.part[i] = hn::Add(a.part[i], b.part[i]);
  return r;
}
HWY_INLINE Eight operator-(const Eight& a, const Eight& b) {
  Eight r;
  for (size_t i = 0; i < kParts; ++i) r.part[i] = hn::Sub(a.part[i], b.part[i]);
  return r;
}
HWY_INLINE Eight operator*(const Eight& a, const Eight& b) {
  Eight r;
  for (size_t i = 0; i < kParts; ++i) r.part[i] = hn::Mul(a.part[i], b.part[i]);
  return r;
}
HWY_INLINE Eight operator/(const Eight& a, const Eight& b) {
  Eight r;
  for (size_t i = 0; i < kParts; ++i) r.part[i] = hn::Div(a.part[i], b.part[i]);
  return r;
}
/// a * b + c and c - a * b, with one rounding or two.
HWY_INLINE Eight multiply_add(const Eight& a, const Eight& b, const Eight& c) {
  Eight r;
  for (size_t i = 0; i < kParts; ++i) r.part[i] = hn::MulAdd(a.part[i], b.part[i], c.part[i]);
  return r;
}
HWY_INLINE Eight subtract_product(const Eight& c, const Eight& a, const Eight& b) {
  Eight r;
  for (size_t i = 0; i < kParts; ++i) r.part[i] = hn::NegMulAdd(a.part[i], b.part[i], c.part[i]);
  return r;
}
HWY_INLINE Eight min(const Eight& a, const Eight& b) {
  Eight r;
  for (size_t i = 0; i < kParts; ++i) r.part[i] = hn::Min(a.part[i], b.part[i]);
  return r;
}
HWY_INLINE Eight max(const Eight& a, const Eight& b) {
  Eight r;
  for (size_t i = 0; i < kParts; ++i) r.part[i] = hn::Max(a.part[i], b.part[i]);
  return r;
}
HWY_INLINE Eight absolute(const Eight& a) {
  Eight r;
  for (size_t i = 0; i < kParts; ++i) r.part[i] = hn::Abs(a.part[i]);
  return r;
}
/// a, or -a where b is negative.
HWY_INLINE Eight times_sign(const Eight& a, const Eight& b) {
  Eight r;
  for (size_t i = 0; i < kParts; ++i) r.part[i] = hn::Xor(a.part[i], hn::And(b.part[i], hn::SignBit(Tag())));
  return r;
}
/// Bit i says a[i] <= b[i]; false for NaN.
HWY_INLINE uint32_t less_equal(const Eight& a, const Eight& b) {
  uint32_t bits = 0;
  for (size_t i = 0; i < kParts; ++i) bits |= bits_of(Tag(), hn::Le(a.part[i], b.part[i])) << (i * kLanes);
  return bits;
}

struct EightVectors {
  Eight x, y, z;
};

template <class Kept>
HWY_INLINE EightVectors broadcast(const Kept (&a)[3]) {
  return {broadcast(a[0]), broadcast(a[1]), broadcast(a[2])};
}
HWY_INLINE EightVectors load_corner(const WideLeaf& leaf, size_t c) {
  return {load_unaligned(leaf.corner(c, 0)), load_unaligned(leaf.corner(c, 1)), load_unaligned(leaf.corner(c, 2))};
}
HWY_INLINE EightVectors operator-(const EightVectors& a, const EightVectors& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE EightVectors cross(const EightVectors& a, const EightVectors& b) {
  return {subtract_product(a.y * b.z, a.z, b.y), subtract_product(a.z * b.x, a.x, b.z),
          subtract_product(a.x * b.y, a.y, b.x)};
}
HWY_INLINE Eight dot(const EightVectors& a, const EightVectors& b) {
  return multiply_add(a.x, b.x, multiply_add(a.y, b.y, a.z * b.z));
}
HWY_INLINE Eight largest_component(const EightVectors& a) {
  return max(max(absolute(a.x), absolute(a.y)), absolute(a.z));
}

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
