// intersect_triangle for several rays at once: the same double-precision filter (src/geometry/triangle.cpp), whose
// proof allows any order of rounding. What it does not decide goes to the one function itself. Included once per
// instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_PAIRS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_PAIRS_INL_H
#undef RAYGRAIN_TRACE_KERNELS_PAIRS_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_PAIRS_INL_H
#endif

#include <algorithm>
#include <array>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "raygrain/mesh.h"
#include "raygrain/triangle.h"

#include "trace/kernels/coverage_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using DoubleTag = hn::CappedTag<double, 4>;
using HalfTag = hn::Rebind<float, DoubleTag>;
using Doubles = hn::Vec<DoubleTag>;

struct DoubleVectors {
  Doubles x, y, z;
};

HWY_INLINE DoubleVectors operator-(const DoubleVectors& a, const DoubleVectors& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE DoubleVectors cross(const DoubleVectors& a, const DoubleVectors& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}
HWY_INLINE Doubles dot(const DoubleVectors& a, const DoubleVectors& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
HWY_INLINE Doubles largest_component(const DoubleVectors& a) {
  return hn::Max(hn::Max(hn::Abs(a.x), hn::Abs(a.y)), hn::Abs(a.z));
}

/// Pairs of a ray (tmin = 0, tmax infinite) and a triangle that wait to be decided together. What they need from memory
/// is fetched for all of them before the first is decided.
class Confirmations {
 public:
  /// Rays that share their start or their direction.
  explicit Confirmations(const ColumnRays& rays) : rays_(rays) {
    common_row_ = rays.kind == ColumnRays::Kind::kFrom ? 9 : 12;
    for (size_t lane = 0; lane < kTogether; ++lane) put(common_row_, lane, rays.common);
  }

  /// True when it is full: decide() then, before the next.
  HWY_INLINE bool add(uint32_t triangle, uint32_t ray) {
    queue_[queued_++] = {triangle, ray};
    return queued_ == kQueue;
  }

  /// Merges the hits into hits[ray].
  void decide(const TriangleMesh& mesh, Hit* hits) {
    const std::array<uint32_t, 3>* triangles = mesh.triangles.data();
    const Vec3* vertices = mesh.vertices.data();
    for (size_t i = 0; i < queued_; ++i) {
      hwy::Prefetch(triangles + queue_[i].triangle);
      hwy::Prefetch(rays_.points + queue_[i].ray);
      hwy::Prefetch(hits + queue_[i].ray);
    }
    for (size_t i = 0; i < queued_; ++i)
      for (const uint32_t corner : triangles[queue_[i].triangle]) hwy::Prefetch(vertices + corner);
    const size_t own_row = 21 - common_row_;
    for (size_t i = 0; i < queued_; i += kTogether) {
      const size_t count = std::min(kTogether, queued_ - i);
      for (size_t lane = 0; lane < kTogether; ++lane) {
        const Pair pair = queue_[i + std::min(lane, count - 1)];
        const auto& corners = triangles[pair.triangle];
        put(0, lane, vertices[corners[0]]);
        put(3, lane, vertices[corners[1]]);
        put(6, lane, vertices[corners[2]]);
        put(own_row, lane, rays_.points[pair.ray]);
      }
      decide_together(queue_ + i, count, hits);
    }
    queued_ = 0;
  }

 private:
  static constexpr size_t kQueue = 64, kTogether = 8;
  struct Pair {
    uint32_t triangle, ray;
  };

  HWY_INLINE void decide_together(const Pair* pairs, size_t count, Hit* hits) {
    uint32_t sure_hits = 0, sure_misses = 0;
    for (size_t lane = 0; lane < count; lane += hn::MaxLanes(DoubleTag())) decide_part(lane, sure_hits, sure_misses);
    for (size_t lane = 0; lane < count; ++lane) {
      if ((sure_misses >> lane & 1) != 0) continue;
      Hit hit{t_[lane], u_[lane], v_[lane], pairs[lane].triangle};
      if ((sure_hits >> lane & 1) == 0 && !ask(lane, hit)) continue;
      Hit& best = hits[pairs[lane].ray];
      if (is_nearer(hit, best)) best = hit;
    }
  }

  HWY_INLINE void put(size_t row, size_t lane, Vec3 a) {
    numbers_[row][lane] = a.x;
    numbers_[row + 1][lane] = a.y;
    numbers_[row + 2][lane] = a.z;
  }
  Vec3 vector(size_t row, size_t lane) const {
    return {numbers_[row][lane], numbers_[row + 1][lane], numbers_[row + 2][lane]};
  }
  HWY_INLINE DoubleVectors load(size_t row, size_t lane) const {
    const DoubleTag d;
    const HalfTag f;
    return {hn::PromoteTo(d, hn::Load(f, numbers_[row] + lane)),
            hn::PromoteTo(d, hn::Load(f, numbers_[row + 1] + lane)),
            hn::PromoteTo(d, hn::Load(f, numbers_[row + 2] + lane))};
  }
  bool ask(size_t i, Hit& hit) const {
    return intersect_triangle({vector(9, i), vector(12, i), 0, kInf}, vector(0, i), vector(3, i), vector(6, i), hit);
  }

  /// As round_quotient: false lanes where two floats come into question.
  static HWY_INLINE auto round(Doubles value, Doubles error, Doubles denominator_error, Doubles inverse,
                               float* result) {
    const DoubleTag d;
    const HalfTag f;
    const Doubles quotient = hn::Mul(value, inverse), size = hn::Abs(quotient);
    const Doubles wrong = hn::Mul(hn::MulAdd(size, denominator_error, error), hn::Abs(inverse));
    const Doubles radius = hn::MulAdd(hn::Set(d, 2.0), wrong, hn::Mul(hn::Set(d, 8 * 0x1p-53), size));
    const auto low = hn::Add(hn::DemoteTo(f, hn::Sub(quotient, radius)), hn::Zero(f));  // no negative zeros
    const auto high = hn::Add(hn::DemoteTo(f, hn::Add(quotient, radius)), hn::Zero(f));
    hn::Store(low, f, result);
    return hn::Eq(hn::PromoteTo(d, low), hn::PromoteTo(d, high));
  }

  HWY_INLINE void decide_part(size_t lane, uint32_t& sure_hits, uint32_t& sure_misses) {
    const DoubleTag d;
    constexpr double kRoundoff = 0x1p-53;
    const DoubleVectors a = load(0, lane), direction = load(12, lane);
    const DoubleVectors to_a = a - load(9, lane), ab = load(3, lane) - a, ac = load(6, lane) - a;
    const DoubleVectors moment = cross(direction, to_a), normal = cross(ab, ac);
    const Doubles sum = dot(direction, normal), weight_c = dot(moment, ab);
    const Doubles weight_b = hn::Neg(dot(moment, ac));
    const Doubles weight_a = hn::Sub(hn::Sub(sum, weight_b), weight_c);
    const Doubles length = largest_component(direction), distance = largest_component(to_a);
    const Doubles size = hn::Max(largest_component(ab), largest_component(ac));
    const Doubles scale = hn::Mul(length, size);
    const Doubles error = hn::Mul(hn::Mul(hn::Set(d, 128 * kRoundoff), scale), hn::Add(distance, size));
    const Doubles lowest = hn::Min(hn::Min(weight_a, weight_b), weight_c);
    const Doubles highest = hn::Max(hn::Max(weight_a, weight_b), weight_c);
    const Doubles minus_error = hn::Neg(error);
    const auto misses = hn::And(hn::Lt(lowest, minus_error), hn::Gt(highest, error));
    const auto inside = hn::Or(hn::Gt(lowest, error), hn::Lt(highest, minus_error));
    const Doubles sum_error = hn::Mul(hn::Mul(hn::Set(d, 64 * kRoundoff), scale), size);
    const auto steep = hn::Gt(hn::Abs(sum), hn::Mul(hn::Set(d, 4.0), sum_error));
    const Doubles inverse = hn::Div(hn::Set(d, 1.0), sum);
    const Doubles numerator_error = hn::Mul(hn::Mul(hn::Set(d, 64 * kRoundoff), distance), hn::Mul(size, size));
    auto sure = hn::And(inside, steep);
    sure = hn::And(sure, round(dot(to_a, normal), numerator_error, sum_error, inverse, t_ + lane));
    sure = hn::And(sure, round(weight_b, error, sum_error, inverse, u_ + lane));
    sure = hn::And(sure, round(weight_c, error, sum_error, inverse, v_ + lane));
    const Doubles t = hn::PromoteTo(d, hn::Load(HalfTag(), t_ + lane));
    const auto in_range = hn::Ge(t, hn::Zero(d));
    sure_hits |= bits(hn::And(sure, in_range)) << lane;
    sure_misses |= bits(hn::Or(misses, hn::AndNot(in_range, sure))) << lane;
  }
  static HWY_INLINE uint32_t bits(hn::Mask<DoubleTag> mask) {
    uint8_t stored[8] = {};
    hn::StoreMaskBits(DoubleTag(), mask, stored);
    return stored[0];
  }

  alignas(64) float numbers_[16][kTogether];                      // NOLINT: corners, origin, direction, tmax
  alignas(32) float t_[kTogether], u_[kTogether], v_[kTogether];  // NOLINT
  Pair queue_[kQueue];                                            // NOLINT: filled as far as queued_
  size_t queued_ = 0;
  size_t common_row_;
  const ColumnRays& rays_;
};

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
