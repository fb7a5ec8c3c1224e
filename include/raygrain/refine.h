// Finished trees made better, or fitted to vertices that moved.
#pragma once

#include <functional>
#include <span>

#include "raygrain/build.h"
#include "raygrain/bvh.h"
#include "raygrain/measure.h"

namespace raygrain {

struct ReinsertOptions {
  uint32_t iterations = 4;  // at most; fewer when one finds nothing
  float share = 1;          // of the nodes that each iteration looks at, in (0, 1]
  unsigned threads = 0;     // 0 = all; the tree is the same for any number
  CostModel costs = {};
  /// Called between iterations with the finished share; false cancels: Error kCancelled, and the tree stays as it was.
  std::function<bool(double done)> progress = {};
};

/// Costs are estimated costs per ray under the measure.
struct ReinsertResult {
  double cost_before = 0, cost_after = 0;
  uint32_t iterations = 0;
  size_t moves = 0;
};

/// Takes subtrees out and puts them back where they cost less: Meister and Bittner, "Parallel reinsertion for bounding
/// volume hierarchy optimization" (2018), under any measure. All threads search the same frozen tree; moves are made
/// one after the other, best first, each only if it still pays. Leaves stay as they are. Never raises the estimated
/// cost; a tree that nothing improves is not touched. Works on trees of any builder, split references included.
///
/// Throws Error: kUsage (options out of range), kBadHeuristic (a measure that is negative or not finite).
ReinsertResult reinsert(Bvh& bvh, const RayMeasure& measure = {}, const ReinsertOptions& options = {});

/// Estimated costs per ray before and after, each relative to the root of its time.
struct RefitResult {
  double cost_before = 0, cost_after = 0;

  /// 1: as good as before; above about 1.3 a new tree pays for most scenes.
  double ratio() const { return cost_before > 0 ? cost_after / cost_before : 1; }
};

/// Fits the boxes to primitives that moved; links and leaves stay. `bounds[i]` is the new box of primitive i. Throws
/// Error (kUsage) for split references, whose leaves' boxes hold parts that only a new build knows, for primitives
/// without a box, and for boxes that are empty or not finite; the tree is then unchanged.
RefitResult refit(Bvh& bvh, std::span<const Bounds> bounds, const RayMeasure& measure = {},
                  const CostModel& costs = {});

}  // namespace raygrain
