#include "accel/bundles.h"

#include <algorithm>
#include <bit>

namespace raygrain {
namespace {

constexpr size_t kProbes = 32;
/// So many rays of a bundle are worth taking them out of an array. Measured: as for kLeastMixed.
constexpr size_t kLeastAmongOthers = 64;

/// 0 if their bits are the same: -0 is not 0.
uint32_t difference(float a, float b) {
  return std::bit_cast<uint32_t>(a) ^ std::bit_cast<uint32_t>(b);
}
uint32_t difference(Vec3 a, Vec3 b) {
  return difference(a.x, b.x) | difference(a.y, b.y) | difference(a.z, b.z);
}
uint32_t difference(const Ray& a, const Ray& b) {
  return difference(a.origin, b.origin) | difference(a.direction, b.direction) | difference(a.tmin, b.tmin) |
         difference(a.tmax, b.tmax);
}

/// What a batch call takes of a ray.
Vec3 point_of(const Shared& shared, bool any, const Ray& ray) {
  return shared.is_point && !any ? ray.direction : ray.origin;
}

/// Is it just the ray that a batch call makes of what it takes?
bool holds(const Shared& shared, bool any, const Ray& ray) {
  return difference(shared.ray(any, point_of(shared, any, ray)), ray) == 0;
}

}  // namespace

// Few rays of an array tell which bundles there are.
Bundles::Bundles(const BatchCoverages& coverages, bool any, std::span<const Ray> rays) : any_(any) {
  if (coverages.is_empty() || rays.size() < kLeastRays) return;
  const bool is_mixed = rays.size() >= kLeastMixed;
  const size_t stride = is_mixed ? rays.size() / kProbes : rays.size();
  for (size_t i = 0; i < rays.size() && size_ < kMost; i += stride) find(coverages, rays[i]);
  const auto is_other = [&](const Ray& ray) { return !holds(shared_[0], any_, ray); };
  const bool is_small = !is_mixed && size_ > 0 && rays.size() < least_rays(coverages, shared_[0]);
  if (is_small || (!is_mixed && size_ > 0 && std::ranges::any_of(rays, is_other))) size_ = 0;
  if (size_ == 0) return;
  divide(rays);
  dissolve_small(coverages);
}

void Bundles::find(const BatchCoverages& coverages, const Ray& ray) {
  for (size_t i = 0; i < size_; ++i)
    if (holds(shared_[i], any_, ray)) return;
  for (const BatchCoverages::Eye& eye : coverages.eyes)
    if (const Shared shared{eye.place, true}; holds(shared, any_, ray)) return void(shared_[size_++] = shared);
  const Shared along{ray.direction, false};
  const auto is_asked = [&](const AreaCoverage& c) { return c.coverage.sense(ray.direction) == (any_ ? 1 : -1); };
  if (holds(along, any_, ray) && std::ranges::any_of(coverages.planes, is_asked)) shared_[size_++] = along;
}

/// Without jumps that depend on the rays: in no order, nobody can guess which bundle comes next.
void Bundles::divide(std::span<const Ray> rays) {
  std::array<std::vector<uint32_t>*, kMost + 1> lists;
  for (size_t k = 0; k < size_; ++k) lists[k] = &numbers_[k];
  lists[size_] = &others_;
  std::array<uint32_t*, kMost + 1> next;
  for (size_t k = 0; k <= size_; ++k) {
    lists[k]->resize(rays.size());
    next[k] = lists[k]->data();
  }
  points_.resize(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) {
    points_[i] = rays[i].origin;
    size_t bundle = size_;
    for (size_t k = size_; k-- > 0;) {
      const size_t is_of = 0 - static_cast<size_t>(holds(shared_[k], any_, rays[i]));
      bundle = (k & is_of) | (bundle & ~is_of);
    }
    *next[bundle]++ = static_cast<uint32_t>(i);
  }
  for (size_t k = 0; k <= size_; ++k) lists[k]->resize(static_cast<size_t>(next[k] - lists[k]->data()));
  for (size_t k = 0; k < size_; ++k)
    for (const uint32_t number : numbers_[k]) points_[number] = point_of(shared_[k], any_, rays[number]);
}

void Bundles::dissolve_small(const BatchCoverages& coverages) {
  for (size_t k = 0; k < size_; ++k) {
    const bool is_alone = numbers_[k].size() == points_.size();
    if (numbers_[k].size() >= (is_alone ? least_rays(coverages, shared_[k]) : kLeastAmongOthers)) continue;
    others_.insert(others_.end(), numbers_[k].begin(), numbers_[k].end());
    numbers_[k].clear();
  }
}

}  // namespace raygrain
