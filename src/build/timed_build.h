// What builders do around their own work: refuse bad options and input, start their log, take the time.
#pragma once

#include <span>

#include "build/laps.h"
#include "build/strategy.h"

namespace raygrain::builder {

/// build(input, laps) -> Bvh. The input that it gets has all centroids.
template <class Build>
Bvh timed_build(std::span<const Bounds> bounds, std::span<const Vec3> centroids, const BuildOptions& options,
                BuildLog* log, const Build& build) {
  validate(options);
  Input input = checked_input(bounds, centroids, options.threads);
  std::vector<Vec3> centers;
  if (centroids.empty()) input.centroids = centers = box_centers(bounds, options.threads);
  if (log) *log = {};
  Laps laps(log ? &log->times : nullptr);
  Bvh bvh = build(input, laps);
  laps.finish();
  return bvh;
}

}  // namespace raygrain::builder
