// The last word on triangles that floats could not drop: the double-precision test of intersect_triangle for as many as
// a vector holds. What it is not certain of goes to intersect_triangle. The answer is defined by real arithmetic, so
// being certain means being equal; docs/theory.md, section "Wide trees in float". Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_CONFIRM_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_CONFIRM_INL_H
#undef RAYGRAIN_TRACE_KERNELS_CONFIRM_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_CONFIRM_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "raygrain/mesh.h"
#include "raygrain/ray.h"
#include "raygrain/triangle.h"

#include "trace/kernels/doubles-inl.h"
#include "trace/wide_tree.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

/// Bit i: triangle i of a group is surely hit, at t, u, v; or is not decided. The others are surely missed.
struct Verdicts {
  uint32_t hit, unsure;
  float t[kDoubles], u[kDoubles], v[kDoubles];
};

/// Rays against triangles, one pair in each lane. `size` is at least every edge component, `length` the largest
/// component of the direction.
struct ConfirmationInput {
  DoubleVectors direction, to_a, ab, ac;
  Doubles length, size;
  Floats tmin, tmax;
};

/// kSure: floats have shown that the weights of all pairs are on one side, that the sum is steep, and that t >= tmin.
template <bool kSure>
HWY_INLINE void confirm(const ConfirmationInput& in, Verdicts& verdicts) {
  constexpr double kUnit = 0x1p-53;  // the bounds are those of triangle.cpp
  const DoubleVectors moment = cross(in.direction, in.to_a), normal = cross(in.ab, in.ac);
  const Doubles sum = dot(in.direction, normal), numerator = dot(in.to_a, normal);
  const Doubles minus_b = dot(moment, in.ac), weight_c = dot(moment, in.ab);
  const Doubles distance = max(max(absolute(in.to_a.x), absolute(in.to_a.y)), absolute(in.to_a.z));
  const Doubles area = in.size * in.size * doubles(64 * kUnit);
  const Doubles sum_error = in.length * area, numerator_error = distance * area;
  const Doubles error = in.length * in.size * doubles(128 * kUnit) * (distance + in.size);

  const Doubles inverse = doubles(1.0) / sum, twice = absolute(inverse + inverse);
  const Doubles t = numerator * inverse, minus_u = minus_b * inverse, v = weight_c * inverse;
  const Doubles t_size = absolute(t);
  const Doubles t_radius =
      multiply_add(multiply_add(t_size, sum_error, numerator_error), twice, t_size * doubles(8 * kUnit));
  // u and v lie in [0, 1] and were computed below 2.
  const Doubles radius = multiply_add(multiply_add(sum_error, doubles(2.0), error), twice, doubles(16 * kUnit));
  const Floats t_low = round(t - t_radius), u_low = round(doubles(0.0) - minus_u - radius), v_low = round(v - radius);
  const uint32_t t_sure = equal(t_low, round(t + t_radius));
  const uint32_t all_sure = t_sure & equal(u_low, round(radius - minus_u)) & equal(v_low, round(v + radius));
  store(t_low, verdicts.t);
  store(u_low, verdicts.u);
  store(v_low, verdicts.v);
  const uint32_t in_range = less_equal(t_low, in.tmax);
  if constexpr (kSure) {
    verdicts.hit = all_sure & in_range;
    verdicts.unsure = ~all_sure;
    return;
  }
  const Doubles weight_b = doubles(0.0) - minus_b, weight_a = sum + minus_b - weight_c;
  const Doubles lowest = min(min(weight_a, weight_b), weight_c), highest = max(max(weight_a, weight_b), weight_c);
  const Doubles below = doubles(0.0) - error;
  const uint32_t miss = less(lowest, below) & less(error, highest);
  const uint32_t inside = less(error, lowest) | less(highest, below);
  const uint32_t usable = inside & less(sum_error * doubles(4.0), absolute(sum));
  const uint32_t outside = usable & t_sure & ~(less_equal(in.tmin, t_low) & in_range);
  verdicts.hit = usable & all_sure & ~outside;
  verdicts.unsure = ~(miss | verdicts.hit | outside);
}

/// One ray against the triangles first ... first + kDoubles - 1 of a leaf.
template <bool kSure>
HWY_INLINE void confirm(const Ray& ray, const WideLeaf& leaf, float size, size_t first, Verdicts& verdicts) {
  const auto corner = [&](size_t c) {
    return DoubleVectors{load_doubles(leaf.corner(c, 0) + first), load_doubles(leaf.corner(c, 1) + first),
                         load_doubles(leaf.corner(c, 2) + first)};
  };
  const Vec3 d = ray.direction;
  const float length = std::max(std::max(std::abs(d.x), std::abs(d.y)), std::abs(d.z));
  const DoubleVectors a = corner(0);
  confirm<kSure>({doubles(d), a - doubles(ray.origin), corner(1) - a, corner(2) - a, doubles(length), doubles(size),
                  floats(ray.tmin), floats(ray.tmax)},
                 verdicts);
}

HWY_INLINE Doubles largest_component(const DoubleVectors& a) {
  return max(max(absolute(a.x), absolute(a.y)), absolute(a.z));
}

/// The hits that verdicts speak of, written as wholes: reading one of them need not wait for its parts.
class VerdictHits {
 public:
  HWY_INLINE VerdictHits(const Verdicts& verdicts, const uint32_t* triangles) {
    static_assert(sizeof(Hit) == 16 && offsetof(Hit, u) == 4 && offsetof(Hit, v) == 8 && offsetof(Hit, triangle) == 12);
    const FloatTag d;
    const auto ids = hn::BitCast(d, hn::LoadU(hn::RebindToUnsigned<FloatTag>(), triangles));
    hn::StoreInterleaved4(load_floats(verdicts.t).v, load_floats(verdicts.u).v, load_floats(verdicts.v).v, ids, d,
                          numbers_);
  }
  HWY_INLINE Hit operator[](size_t i) const {
    Hit hit;
    std::memcpy(static_cast<void*>(&hit), numbers_ + 4 * i, sizeof hit);
    return hit;
  }

 private:
  alignas(64) float numbers_[4 * kDoubles];
};

/// One ray against one triangle, as intersect_triangle, and the triangle's number.
HWY_INLINE bool confirm(const Ray& ray, const TriangleMesh& mesh, uint32_t id, Hit& hit) {
  const Vec3 a = mesh.vertex(id, 0), b = mesh.vertex(id, 1), c = mesh.vertex(id, 2);
  const DoubleVectors corner = doubles(a), ab = doubles(b) - corner, ac = doubles(c) - corner,
                      direction = doubles(ray.direction);
  const Doubles size = max(largest_component(ab), largest_component(ac));
  Verdicts verdicts;  // NOLINT: written by confirm
  confirm<false>({direction, corner - doubles(ray.origin), ab, ac, largest_component(direction), size, floats(ray.tmin),
                  floats(ray.tmax)},
                 verdicts);
  uint32_t ids[kDoubles];
  for (uint32_t& i : ids) i = id;
  const VerdictHits hits(verdicts, ids);
  if ((verdicts.unsure & 1) != 0) [[unlikely]] {
    if (!intersect_triangle(ray, a, b, c, hit)) return false;
    hit.triangle = id;
    return true;
  }
  if ((verdicts.hit & 1) == 0) return false;
  hit = hits[0];
  return true;
}

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
