#include "build/input.h"

#include <limits>
#include <string>

#include "raygrain/error.h"

#include "base/parallel.h"

namespace raygrain::builder {

namespace {

constexpr size_t kChunk = 16384;
constexpr size_t kNone = std::numeric_limits<size_t>::max();

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

[[noreturn]] void refuse(const Bounds& box, size_t i) {
  if (!is_good(box))
    throw Error(ErrorCode::kUsage, "bounds[" + std::to_string(i) + "]", "box is empty or not finite",
                "give each primitive a finite box");
  throw Error(ErrorCode::kUsage, "centroids[" + std::to_string(i) + "]", "centroid is not finite",
              "give each primitive a finite centroid");
}

}  // namespace

Input checked_input(std::span<const Bounds> bounds, std::span<const Vec3> centroids, std::vector<Vec3>& centers,
                    unsigned threads) {
  check_sizes(bounds, centroids);
  struct Part {
    Bounds reach;
    size_t bad = kNone;
  };
  std::vector<Part> parts((bounds.size() + kChunk - 1) / kChunk);
  if (centroids.empty()) centers.resize(bounds.size());
  parallel_for(bounds.size(), kChunk, threads, [&](size_t begin, size_t end) {
    Part part;
    for (size_t i = begin; i < end && part.bad == kNone; ++i) {
      const Vec3 centroid = centroids.empty() ? centers[i] = center(bounds[i]) : centroids[i];
      part.reach.extend(bounds[i]);
      part.reach.extend(centroid);
      if (!is_good(bounds[i]) || !is_finite(centroid)) part.bad = i;
    }
    parts[begin / kChunk] = part;
  });
  Input input{bounds, centroids.empty() ? std::span<const Vec3>(centers) : centroids, {}};
  for (const Part& part : parts) {
    if (part.bad != kNone) refuse(bounds[part.bad], part.bad);
    input.reach.extend(part.reach);
  }
  return input;
}

}  // namespace raygrain::builder
