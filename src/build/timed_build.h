// What builders do around their own work: complete the input, start their log, take the time.
#pragma once

#include <vector>

#include "build/laps.h"
#include "build/strategy.h"

namespace raygrain::builder {

/// build(input, laps) -> Bvh. The input that it gets is this one, checked before, with all centroids.
template <class Build>
Bvh timed_build(Input input, const BuildOptions& options, BuildLog* log, const Build& build) {
  std::vector<Vec3> centers;
  if (input.centroids.empty()) input.centroids = centers = box_centers(input.bounds, options.threads);
  if (log) *log = {};
  Laps laps(log ? &log->times : nullptr);
  Bvh bvh = build(input, laps);
  laps.finish();
  return bvh;
}

}  // namespace raygrain::builder
