// What every builder does around its own work: refuse bad options and input, start its log, take the time.
#pragma once

#include <span>

#include "build/laps.h"
#include "build/strategy.h"

namespace raygrain::builder {

/// build(input, laps) -> Bvh.
template <class Build>
Bvh timed_build(std::span<const Bounds> bounds, std::span<const Vec3> centroids, const BuildOptions& options,
                BuildLog* log, const Build& build) {
  validate(options);
  std::vector<Vec3> centers;
  const Input input = checked_input(bounds, centroids, centers, options.threads);
  if (log) *log = {};
  Laps laps(log ? &log->times : nullptr);
  Bvh bvh = build(input, laps);
  laps.finish();
  return bvh;
}

}  // namespace raygrain::builder
