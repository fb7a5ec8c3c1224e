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
#include <bit>

#include <hwy/cache_control.h>

#include "raygrain/mesh.h"
#include "raygrain/triangle.h"

#include "trace/kernels/compress-inl.h"
#include "trace/kernels/confirm-inl.h"
#include "trace/kernels/coverage_packets-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

/// Pairs of a ray (tmin = 0, tmax infinite) and a triangle that wait to be decided together. What they need from memory
/// is fetched for all of them before the first is decided. The rays share their start or their direction.
class Confirmations {
 public:
  /// Hits are merged into hits[number of the ray].
  Confirmations(const TriangleMesh& mesh, const ColumnRays& rays, Hit* hits)
      : mesh_(mesh), rays_(rays), hits_(hits), share_start_(rays.kind == ColumnRays::Kind::kFrom) {}

  HWY_INLINE void add(uint32_t triangle, uint32_t ray) {
    hwy::Prefetch(hits_ + ray);
    const Vec3 point = rays_.points[ray];
    points_[0][queued_] = point.x;
    points_[1][queued_] = point.y;
    points_[2][queued_] = point.z;
    triangles_[queued_] = triangle;
    numbers_[queued_] = ray;
    if (++queued_ >= kQueue) decide();
  }

  /// Of as many rays as a packet has, those in the mask, with triangles of their own.
  HWY_INLINE void add(const Packet& packet, const uint32_t* triangles, const uint32_t* rays, uint32_t lanes) {
    const ColumnTag d;
    const hn::RebindToUnsigned<ColumnTag> du;
    const PacketMask mask = mask_of(d, lanes);
    const auto integer_mask = hn::RebindMask(du, mask);
    hn::StoreU(compressed(d, packet.px, mask), d, points_[0] + queued_);
    hn::StoreU(compressed(d, packet.py, mask), d, points_[1] + queued_);
    hn::StoreU(compressed(d, packet.pz, mask), d, points_[2] + queued_);
    hn::StoreU(compressed(du, hn::LoadU(du, triangles), integer_mask), du, triangles_ + queued_);
    hn::StoreU(compressed(du, hn::LoadU(du, rays), integer_mask), du, numbers_ + queued_);
    queued_ += static_cast<size_t>(std::popcount(lanes));
    if (queued_ >= kQueue) decide();
  }

  void decide() {
    if (queued_ == 0) return;
    const std::array<uint32_t, 3>* corners = mesh_.triangles.data();
    const Vec3* vertices = mesh_.vertices.data();
    for (size_t i = 0; i < queued_; ++i) hwy::Prefetch(corners + triangles_[i]);
    for (size_t i = 0; i < queued_; ++i)
      for (const uint32_t corner : corners[triangles_[i]]) hwy::Prefetch(vertices + corner);
    for (size_t i = 0; i < queued_; ++i)
      for (size_t corner = 0; corner < 3; ++corner) put(corner, i, vertices[corners[triangles_[i]][corner]]);
    for (size_t first = 0; first < queued_; first += kDoubles) decide(first, std::min(kDoubles, queued_ - first));
    queued_ = 0;
  }

 private:
  static constexpr size_t kQueue = 64, kRoom = kQueue + 16;  // whole cache lines
  static_assert(kRoom >= kQueue - 1 + 2 * kPacket);

  HWY_INLINE void decide(size_t first, size_t count) {
    const DoubleVectors own{load_doubles(points_[0] + first), load_doubles(points_[1] + first),
                            load_doubles(points_[2] + first)};
    const DoubleVectors common = doubles(rays_.common);
    const DoubleVectors direction = share_start_ ? own : common, origin = share_start_ ? common : own;
    const DoubleVectors a = corner(0, first), ab = corner(1, first) - a, ac = corner(2, first) - a;
    const Doubles size = max(largest_component(ab), largest_component(ac));
    Verdicts verdicts;  // NOLINT: written by confirm
    confirm<false>({direction, a - origin, ab, ac, largest_component(direction), size, floats(0), floats(kInf)},
                   verdicts);
    const VerdictHits hits(verdicts, triangles_ + first);
    for (size_t i = 0; i < count; ++i) {
      const uint32_t number = numbers_[first + i];
      const bool is_sure = (verdicts.hit >> i & 1) != 0;
      Hit hit = hits[i];
      if (!is_sure && ((verdicts.unsure >> i & 1) == 0 || !ask(number, first + i, hit))) continue;
      if (is_nearer(hit, hits_[number])) hits_[number] = hit;
    }
  }

  HWY_INLINE void put(size_t corner, size_t i, Vec3 a) {
    corners_[corner][0][i] = a.x;
    corners_[corner][1][i] = a.y;
    corners_[corner][2][i] = a.z;
  }
  HWY_INLINE DoubleVectors corner(size_t c, size_t first) const {
    return {load_doubles(corners_[c][0] + first), load_doubles(corners_[c][1] + first),
            load_doubles(corners_[c][2] + first)};
  }
  Vec3 vertex(size_t c, size_t i) const { return {corners_[c][0][i], corners_[c][1][i], corners_[c][2][i]}; }
  bool ask(uint32_t number, size_t i, Hit& hit) const {
    hit.triangle = triangles_[i];
    return intersect_triangle(rays_[number], vertex(0, i), vertex(1, i), vertex(2, i), hit);
  }

  alignas(64) float points_[3][kRoom];      // NOLINT: filled as far as queued_
  alignas(64) uint32_t triangles_[kRoom];   // NOLINT
  alignas(64) uint32_t numbers_[kRoom];     // NOLINT
  alignas(64) float corners_[3][3][kRoom];  // NOLINT
  const TriangleMesh& mesh_;
  const ColumnRays& rays_;
  Hit* hits_;
  size_t queued_ = 0;
  bool share_start_;
};

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
