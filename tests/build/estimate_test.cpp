#include "build/estimate.h"

#include <gtest/gtest.h>

namespace raygrain {
namespace {

TEST(Estimate, SumsProbabilitiesTimesCosts) {
  Bvh tree;
  tree.nodes.push_back({{{0, 0, 0}, {4, 1, 1}}, 1, 0});
  tree.nodes.push_back({{{0, 0, 0}, {1, 1, 1}}, 0, 2});
  tree.nodes.push_back({{{1, 0, 0}, {4, 1, 1}}, 2, 3});
  tree.prims = {0, 1, 2, 3, 4};
  const RayMeasure width([](const Bounds& box) { return box.hi.x - box.lo.x; });
  EXPECT_DOUBLE_EQ(estimated_cost(tree, width, {2, 1.5f}), 2 + 0.25 * 2 * 1.5 + 0.75 * 3 * 1.5);
  // An absolute total scales probabilities, which never exceed 1.
  const RayMeasure window([](const Bounds& box) { return box.hi.x - box.lo.x; }, 2.0f);
  EXPECT_DOUBLE_EQ(estimated_cost(tree, window, {2, 1.5f}), 2 + 0.5 * 2 * 1.5 + 1.0 * 3 * 1.5);
}

TEST(Estimate, IsNothingWhereNoRayComes) {
  EXPECT_EQ(estimated_cost({}, RayMeasure()), 0);
  Bvh tree;
  tree.nodes.push_back({{{0, 0, 0}, {0, 0, 0}}, 0, 1});
  tree.prims = {0};
  EXPECT_EQ(estimated_cost(tree, RayMeasure()), 0);
}

}  // namespace
}  // namespace raygrain
