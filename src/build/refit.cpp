#include <cmath>
#include <string>

#include "raygrain/error.h"
#include "raygrain/refine.h"

#include "build/estimate.h"

namespace raygrain {

namespace {

void check(const Bvh& bvh, std::span<const Bounds> bounds) {
  if (bvh.split_references)
    throw Error(ErrorCode::kUsage, "tree", "has split references, which cannot be refitted",
                "build it anew, or build trees that are to be refitted without spatial splits");
  for (const uint32_t prim : bvh.prims) {
    const std::string where = "bounds[" + std::to_string(prim) + "]";
    if (prim >= bounds.size()) throw Error(ErrorCode::kUsage, where, "is missing", "give a box for each primitive");
    const Bounds& box = bounds[prim];
    if (is_empty(box) || !is_finite(box.lo) || !is_finite(box.hi))
      throw Error(ErrorCode::kUsage, where, "box is empty or not finite", "give each primitive a finite box");
  }
}

}  // namespace

RefitResult refit(Bvh& bvh, std::span<const Bounds> bounds, const RayMeasure& measure, const CostModel& costs) {
  check(bvh, bounds);
  RefitResult result;
  result.cost_before = estimated_cost(bvh, measure, costs);
  // Children stand after their parent.
  for (size_t i = bvh.nodes.size(); i-- > 0;) {
    Bvh::Node& node = bvh.nodes[i];
    Bounds box;
    if (node.is_leaf())
      for (uint32_t k = node.first; k < node.first + node.count; ++k) box.extend(bounds[bvh.prims[k]]);
    else
      box = united(bvh.nodes[node.first].bounds, bvh.nodes[node.first + 1].bounds);
    node.bounds = box;
  }
  result.cost_after = estimated_cost(bvh, measure, costs);
  return result;
}

}  // namespace raygrain
