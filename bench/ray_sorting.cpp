#include "ray_sorting.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"

namespace raygrain::bench {
namespace {

uint32_t spread_bits(uint32_t x) {
  x = (x | x << 8) & 0x00ff00ffu;
  x = (x | x << 4) & 0x0f0f0f0fu;
  x = (x | x << 2) & 0x33333333u;
  return (x | x << 1) & 0x55555555u;
}

/// Where a ray crosses its frame, up to scale.
struct Crossing {
  float x, y;
};

Crossing crossing(const StructuredRays& rays, const AreaGeometry& geometry, const Ray& ray) {
  const Frame& frame = geometry.frame();
  if (geometry.is_plane()) {
    const Vec3d p = to_local(frame, to_double(ray.origin));
    return {static_cast<float>(p.x), static_cast<float>(p.y)};
  }
  const Vec3d from = rays.sharing == Sharing::kStart ? to_double(ray.direction) : to_double(ray.origin) - frame.origin;
  const Vec3d d = to_local_direction(frame, from);  // octahedral: good for all directions
  const double sum = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
  const double x = d.x / sum, y = d.y / sum;
  if (d.z >= 0) return {static_cast<float>(x), static_cast<float>(y)};
  return {static_cast<float>(std::copysign(1 - std::abs(y), x)), static_cast<float>(std::copysign(1 - std::abs(x), y))};
}

}  // namespace

RaySorter::RaySorter(const StructuredRays& rays, unsigned threads)
    : rays_(rays),
      geometry_(rays.areas.front()),
      threads_(threads == 0 ? default_threads() : threads),
      items_(rays.set.rays.size()),
      others_(rays.set.rays.size()),
      places_(threads_),
      sorted_(rays.set) {}

template <class Body>
void RaySorter::for_parts(const Body& body) const {
  const size_t count = items_.size(), part = std::max<size_t>(1, (count + threads_ - 1) / threads_);
  parallel_for(count, part, threads_, [&](size_t begin, size_t end) { body(begin / part, begin, end); });
}

void RaySorter::make_keys() {
  constexpr uint32_t kCells = 1u << (kDigitBits * kDigits / 2);  // across
  const Vec2d half = geometry_.is_plane() ? geometry_.window_half() : Vec2d{1, 1};
  const float middle = kCells / 2, last = kCells - 1;
  const float scale_x = static_cast<float>(0.5 * kCells / half.x), scale_y = static_cast<float>(0.5 * kCells / half.y);
  const auto cell = [&](float x) { return spread_bits(static_cast<uint32_t>(std::clamp(x + middle, 0.0f, last))); };
  for_parts([&](size_t, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const Crossing at = crossing(rays_, geometry_, rays_.set.rays[i]);
      items_[i] = {cell(at.x * scale_x) | cell(at.y * scale_y) << 1, static_cast<uint32_t>(i)};
    }
  });
}

void RaySorter::sort_by_digit(unsigned shift) {
  const auto bucket = [shift](const Keyed& k) { return k.key >> shift & (kBuckets - 1); };
  for (auto& places : places_) places.fill(0);
  for_parts([&](size_t part, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) ++places_[part][bucket(items_[i])];
  });
  uint32_t next = 0;
  for (size_t b = 0; b < kBuckets; ++b)
    for (auto& places : places_) next += std::exchange(places[b], next);
  for_parts([&](size_t part, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) others_[places_[part][bucket(items_[i])]++] = items_[i];
  });
  items_.swap(others_);
}

const BenchRays& RaySorter::sort() {
  make_keys();
  for (unsigned digit = 0; digit < kDigits; ++digit) sort_by_digit(digit * kDigitBits);
  for_parts([&](size_t, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) sorted_.rays[i] = rays_.set.rays[items_[i].number];
  });
  return sorted_;
}

void RaySorter::unsort(const Answers& found, Answers& answers) const {
  for_parts([&](size_t, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      if (rays_.set.any)
        answers.flags[items_[i].number] = found.flags[i];
      else
        answers.hits[items_[i].number] = found.hits[i];
    }
  });
}

}  // namespace raygrain::bench
