// intersect_triangle for several rays at once, each with a triangle of its own. What doubles do not decide goes to the
// one function itself. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_PAIRS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_PAIRS_INL_H
#undef RAYGRAIN_TRACE_KERNELS_PAIRS_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_PAIRS_INL_H
#endif

#include <algorithm>
#include <array>

#include <hwy/cache_control.h>

#include "raygrain/mesh.h"
#include "raygrain/triangle.h"

#include "trace/kernels/confirm-inl.h"
#include "trace/kernels/coverage_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

HWY_INLINE Doubles largest_component(const DoubleVectors& a) {
  return max(max(absolute(a.x), absolute(a.y)), absolute(a.z));
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
    for (size_t first = 0; first < count; first += kDoubles) {
      Verdicts verdicts;  // NOLINT: written by confirm
      const DoubleVectors a = load(0, first), direction = load(12, first), ab = load(3, first) - a,
                          ac = load(6, first) - a;
      const Doubles size = max(largest_component(ab), largest_component(ac));
      confirm<false>(
          {direction, a - load(9, first), ab, ac, largest_component(direction), size, floats(0), floats(kInf)},
          verdicts);
      for (size_t i = 0; i < std::min(kDoubles, count - first); ++i) {
        const Pair pair = pairs[first + i];
        Hit hit{verdicts.t[i], verdicts.u[i], verdicts.v[i], pair.triangle};
        const bool is_sure = (verdicts.hit >> i & 1) != 0;
        if (!is_sure && ((verdicts.unsure >> i & 1) == 0 || !ask(first + i, hit))) continue;
        Hit& best = hits[pair.ray];
        if (is_nearer(hit, best)) best = hit;
      }
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
    return {load_doubles(numbers_[row] + lane), load_doubles(numbers_[row + 1] + lane),
            load_doubles(numbers_[row + 2] + lane)};
  }
  bool ask(size_t i, Hit& hit) const {
    return intersect_triangle({vector(9, i), vector(12, i), 0, kInf}, vector(0, i), vector(3, i), vector(6, i), hit);
  }

  alignas(64) float numbers_[15][kTogether];  // NOLINT: corners, origin, direction
  Pair queue_[kQueue];                        // NOLINT: filled as far as queued_
  size_t queued_ = 0;
  size_t common_row_;
  const ColumnRays& rays_;
};

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
