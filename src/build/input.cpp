#include "build/input.h"

#include <string>

#include "raygrain/error.h"

#include "base/parallel.h"

namespace raygrain::builder {

namespace {

constexpr size_t kChunk = 16384;

void check_sizes(std::span<const Bounds> bounds, std::span<const Vec3> centroids) {
  if (!centroids.empty() && bounds.size() != centroids.size())
    throw Error(ErrorCode::kUsage, "centroids",
                std::to_string(centroids.size()) + " centroids for " + std::to_string(bounds.size()) + " boxes",
                "give one centroid per box");
  // A tree over n primitives has up to 2n - 1 nodes.
  if (bounds.size() > size_t{1} << 31)
    throw Error(ErrorCode::kLimit, "bounds", "more primitives than 32-bit node indices can hold", "split the input");
}

bool is_good(const Bounds& box) {
  return is_finite(box.lo) && is_finite(box.hi) && !is_empty(box);
}

[[noreturn]] void refuse_first_bad(const Input& input, size_t from) {
  const auto is_bad_centroid = [&](size_t i) { return !input.centroids.empty() && !is_finite(input.centroids[i]); };
  size_t i = from;
  while (is_good(input.bounds[i]) && !is_bad_centroid(i)) ++i;
  if (!is_good(input.bounds[i]))
    throw Error(ErrorCode::kUsage, "bounds[" + std::to_string(i) + "]", "box is empty or not finite",
                "give each primitive a finite box");
  throw Error(ErrorCode::kUsage, "centroids[" + std::to_string(i) + "]", "centroid is not finite",
              "give each primitive a finite centroid");
}

/// The box of primitives [begin, end), empty where one of them is bad: a box with all of lo <= hi has no NaN, and what
/// is infinite shows in the box of all.
Bounds reach_of_good(const Input& input, size_t begin, size_t end) {
  Bounds reach;
  bool good = true;
  for (size_t i = begin; i < end; ++i) {
    const Bounds& box = input.bounds[i];
    reach.extend(box);
    good &= static_cast<int>(box.lo.x <= box.hi.x) & static_cast<int>(box.lo.y <= box.hi.y) &
            static_cast<int>(box.lo.z <= box.hi.z);
  }
  if (!input.centroids.empty())
    for (size_t i = begin; i < end; ++i) {
      reach.extend(input.centroids[i]);
      good &= is_finite(input.centroids[i]);
    }
  return good && is_finite(reach.lo) && is_finite(reach.hi) ? reach : Bounds{};
}

}  // namespace

Input checked_input(std::span<const Bounds> bounds, std::span<const Vec3> centroids, unsigned threads) {
  check_sizes(bounds, centroids);
  Input input{bounds, centroids, {}};
  std::vector<Bounds> parts((bounds.size() + kChunk - 1) / kChunk);
  parallel_for(bounds.size(), kChunk, threads,
               [&](size_t begin, size_t end) { parts[begin / kChunk] = reach_of_good(input, begin, end); });
  for (size_t part = 0; part < parts.size(); ++part) {
    if (is_empty(parts[part])) refuse_first_bad(input, part * kChunk);
    input.reach.extend(parts[part]);
  }
  return input;
}

std::vector<Vec3> box_centers(std::span<const Bounds> bounds, unsigned threads) {
  std::vector<Vec3> centers(bounds.size());
  parallel_for(bounds.size(), kChunk, threads, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) centers[i] = center(bounds[i]);
  });
  return centers;
}

}  // namespace raygrain::builder
