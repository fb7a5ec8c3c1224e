// What several analyses need to know of every node at once.
#pragma once

#include <cstdint>
#include <vector>

#include "raygrain/area.h"
#include "raygrain/build.h"
#include "raygrain/bvh.h"
#include "raygrain/measure.h"

namespace raygrain {

/// Level of each node (root = 0).
std::vector<uint32_t> node_levels(const Bvh& bvh);

/// The measure of each node's box, asked in one call.
std::vector<float> node_measures(const Bvh& bvh, const RayMeasure& measure);

/// What a ray pays that meets the node's box.
double node_price(const Bvh::Node& node, const CostModel& costs);

/// Projected area that two siblings share, and the smaller one's.
struct SiblingOverlap {
  double common = 0, smaller = 0;
};
SiblingOverlap sibling_overlap(const AreaGeometry& area, const Bounds& left, const Bounds& right, Culling culling);

}  // namespace raygrain
