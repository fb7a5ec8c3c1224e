// As many doubles as a vector holds, at most eight. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_DOUBLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_DOUBLES_INL_H
#undef RAYGRAIN_TRACE_KERNELS_DOUBLES_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_DOUBLES_INL_H
#endif

#include <hwy/highway.h>

#include "raygrain/vec.h"

#include "trace/kernels/masks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using DoubleTag = hn::CappedTag<double, 4>;
using FloatTag = hn::Rebind<float, DoubleTag>;  // as many floats
constexpr size_t kDoubles = hn::MaxLanes(DoubleTag());

struct Doubles {
  hn::Vec<DoubleTag> v;
};

HWY_INLINE Doubles doubles(double x) {
  return {hn::Set(DoubleTag(), x)};
}
HWY_INLINE Doubles load_doubles(const float* from) {
  return {hn::PromoteTo(DoubleTag(), hn::LoadU(FloatTag(), from))};
}
HWY_INLINE Doubles operator+(Doubles a, Doubles b) {
  return {hn::Add(a.v, b.v)};
}
HWY_INLINE Doubles operator-(Doubles a, Doubles b) {
  return {hn::Sub(a.v, b.v)};
}
HWY_INLINE Doubles operator*(Doubles a, Doubles b) {
  return {hn::Mul(a.v, b.v)};
}
HWY_INLINE Doubles operator/(Doubles a, Doubles b) {
  return {hn::Div(a.v, b.v)};
}
/// a * b + c and c - a * b, with one rounding or two.
HWY_INLINE Doubles multiply_add(Doubles a, Doubles b, Doubles c) {
  return {hn::MulAdd(a.v, b.v, c.v)};
}
HWY_INLINE Doubles subtract_product(Doubles c, Doubles a, Doubles b) {
  return {hn::NegMulAdd(a.v, b.v, c.v)};
}
HWY_INLINE Doubles min(Doubles a, Doubles b) {
  return {hn::Min(a.v, b.v)};
}
HWY_INLINE Doubles max(Doubles a, Doubles b) {
  return {hn::Max(a.v, b.v)};
}
HWY_INLINE Doubles absolute(Doubles a) {
  return {hn::Abs(a.v)};
}
/// Bit i says a[i] < b[i]; false for NaN.
HWY_INLINE uint32_t less(Doubles a, Doubles b) {
  return bits_of(DoubleTag(), hn::Lt(a.v, b.v));
}

/// The floats nearest to a, zeros positive.
struct Floats {
  hn::Vec<FloatTag> v;
};
HWY_INLINE Floats round(Doubles a) {
  return {hn::Add(hn::DemoteTo(FloatTag(), a.v), hn::Zero(FloatTag()))};
}
HWY_INLINE Floats floats(float x) {
  return {hn::Set(FloatTag(), x)};
}
HWY_INLINE Floats load_floats(const float* from) {
  return {hn::LoadU(FloatTag(), from)};
}
HWY_INLINE uint32_t equal(Floats a, Floats b) {
  return bits_of(FloatTag(), hn::Eq(a.v, b.v));
}
HWY_INLINE uint32_t less_equal(Floats a, Floats b) {
  return bits_of(FloatTag(), hn::Le(a.v, b.v));
}
HWY_INLINE void store(Floats a, float* to) {
  hn::StoreU(a.v, FloatTag(), to);
}

struct DoubleVectors {
  Doubles x, y, z;
};
HWY_INLINE DoubleVectors doubles(Vec3 a) {
  return {doubles(a.x), doubles(a.y), doubles(a.z)};
}
HWY_INLINE DoubleVectors operator-(const DoubleVectors& a, const DoubleVectors& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE DoubleVectors cross(const DoubleVectors& a, const DoubleVectors& b) {
  return {subtract_product(a.y * b.z, a.z, b.y), subtract_product(a.z * b.x, a.x, b.z),
          subtract_product(a.x * b.y, a.y, b.x)};
}
HWY_INLINE Doubles dot(const DoubleVectors& a, const DoubleVectors& b) {
  return multiply_add(a.x, b.x, multiply_add(a.y, b.y, a.z * b.z));
}

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
