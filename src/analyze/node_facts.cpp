#include "analyze/node_facts.h"

#include <algorithm>

namespace raygrain {

std::vector<uint32_t> node_levels(const Bvh& bvh) {
  std::vector<uint32_t> levels(bvh.nodes.size(), 0);
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    const Bvh::Node& node = bvh.nodes[i];
    if (node.is_leaf()) continue;
    levels[node.first] = levels[node.first + 1] = levels[i] + 1;  // children stand after their parent
  }
  return levels;
}

std::vector<float> node_measures(const Bvh& bvh, const RayMeasure& measure) {
  std::vector<Bounds> boxes(bvh.nodes.size());
  for (size_t i = 0; i < boxes.size(); ++i) boxes[i] = bvh.nodes[i].bounds;
  std::vector<float> measures(boxes.size());
  measure(boxes, measures);
  return measures;
}

double node_price(const Bvh::Node& node, const CostModel& costs) {
  return node.is_leaf() ? static_cast<double>(node.count) * static_cast<double>(costs.triangle)
                        : static_cast<double>(costs.inner);
}

SiblingOverlap sibling_overlap(const AreaGeometry& area, const Bounds& left, const Bounds& right, Culling culling) {
  const ConvexPolygon left_hull = area.projected_hull(left, culling);
  const ConvexPolygon right_hull = area.projected_hull(right, culling);
  const double smaller = std::min(polygon_area(left_hull), polygon_area(right_hull));
  if (!(smaller > 0)) return {};
  const double common = polygon_area(intersect_convex(left_hull, right_hull));
  return {std::min(common, smaller), smaller};
}

}  // namespace raygrain
