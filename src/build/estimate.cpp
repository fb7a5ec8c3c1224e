#include "build/estimate.h"

#include <algorithm>

namespace raygrain {

double estimated_cost(const Bvh& bvh, const RayMeasure& measure, const CostModel& costs) {
  if (bvh.nodes.empty()) return 0;
  std::vector<Bounds> boxes;
  boxes.reserve(bvh.nodes.size());
  for (const Bvh::Node& node : bvh.nodes) boxes.push_back(node.bounds);
  std::vector<float> measures(boxes.size());
  measure(boxes, measures);

  const double total = static_cast<double>(measure.total(boxes.front()));
  if (!(total > 0)) return 0;
  double cost = 0;
  for (size_t i = 0; i < measures.size(); ++i) {
    const Bvh::Node& node = bvh.nodes[i];
    const double probability = std::min(static_cast<double>(measures[i]) / total, 1.0);
    const double visit =
        node.is_leaf() ? node.count * static_cast<double>(costs.triangle) : static_cast<double>(costs.inner);
    cost += probability * visit;
  }
  return cost;
}

}  // namespace raygrain
