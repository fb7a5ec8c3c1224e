// The predicted cost of a tree.
#pragma once

#include "raygrain/build.h"
#include "raygrain/bvh.h"
#include "raygrain/measure.h"

namespace raygrain {

/// Mean cost of a ray of the measure's distribution: the sum of p * inner over inner nodes and p * n * triangle over
/// leaves, p = min(measure / total, 1). 0 for an empty tree.
double estimated_cost(const Bvh& bvh, const RayMeasure& measure, const CostModel& costs = {});

}  // namespace raygrain
