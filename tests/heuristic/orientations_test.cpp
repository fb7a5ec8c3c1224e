// LSPH, SPFH and round robin by hand, on the edges of their definitions.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/heuristics.h"

#include "base/random.h"

namespace raygrain::test {
namespace {

NodeContext node_with(const Bounds& bounds, int parent_axis = -1) {
  NodeContext node;
  node.bounds = bounds;
  node.parent_axis = parent_axis;
  return node;
}

void expect_order(const AxisOrder& order, std::initializer_list<AxisChoice> expected) {
  ASSERT_EQ(order.count, static_cast<int>(expected.size()));
  size_t i = 0;
  for (const AxisChoice& choice : expected) {
    EXPECT_EQ(order.choices[i].axis, choice.axis) << "place " << i;
    EXPECT_FLOAT_EQ(order.choices[i].quality, choice.quality) << "place " << i;
    ++i;
  }
}

InfluenceArea plane_area(Vec3 direction) {
  PlaneArea plane;
  plane.direction = direction;
  return {"plane", plane};
}

InfluenceArea point_area(Vec3 eye, Vec3 forward) {
  PointArea point;
  point.eye = eye;
  point.forward = forward;
  return {"point", point};
}

const Bounds kUnit{{0, 0, 0}, {1, 1, 1}};

TEST(LongestAxis, QualityIsTheShareOfTheLongestExtent) {
  const SplitOrientation lsph = longest_axis_orientation();
  expect_order(lsph(node_with({{1, 1, 1}, {3, 9, 5}})), {{1, 1}, {2, 0.5f}, {0, 0.25f}});
  expect_order(lsph(node_with(kUnit)), {{0, 1}, {1, 1}, {2, 1}});
  expect_order(lsph(node_with({{0, 0, 0}, {0, 0, 2}})), {{2, 1}, {0, 0}, {1, 0}});
}

TEST(LongestAxis, PointsAndHugeBoxesHaveFiniteQualities) {
  const SplitOrientation lsph = longest_axis_orientation();
  expect_order(lsph(node_with({{1, 1, 1}, {1, 1, 1}})), {{0, 1}, {1, 1}, {2, 1}});
  const float big = std::numeric_limits<float>::max();
  expect_order(lsph(node_with({{-big, -big, 0}, {big, 0, big}})), {{0, 1}, {1, 0.5f}, {2, 0.5f}});
}

TEST(Facing, PlaneAreasHaveOneOrderForAllNodes) {
  // |v| / sum = (0.2, 0.3, 0.5), in either sense and of any length.
  for (const float scale : {1.0f, -1.0f, 1e-20f, 1e20f}) {
    SCOPED_TRACE(scale);
    const SplitOrientation spfh = facing_orientation(plane_area(Vec3{2, -3, 5} * scale));
    expect_order(spfh(node_with(kUnit)), {{0, 0.64f}, {1, 0.49f}, {2, 0.25f}});
    expect_order(spfh(node_with({{-9, 5, 5}, {7, 8, 1000}})), {{0, 0.64f}, {1, 0.49f}, {2, 0.25f}});
  }
}

TEST(Facing, RaysAlongAnAxisLeaveTheOtherTwo) {
  expect_order(facing_orientation(plane_area({0, -1, 0}))(node_with(kUnit)), {{0, 1}, {2, 1}, {1, 0}});
}

TEST(Facing, TheBestQualityIsAtLeastFourNinths) {
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 v{static_cast<float>(random.uniform(-1, 1)), static_cast<float>(random.uniform(-1, 1)),
                 static_cast<float>(random.uniform(-1, 1))};
    const AxisOrder order = facing_orientation(plane_area(v))(node_with(kUnit));
    EXPECT_GE(order.choices[0].quality, 0.444444f);
    EXPECT_GE(order.choices[0].quality, order.choices[1].quality);
    EXPECT_GE(order.choices[1].quality, order.choices[2].quality);
  }
}

TEST(Facing, PointAreasLookFromTheEyeToTheMiddle) {
  const SplitOrientation spfh = facing_orientation(point_area({10, 0, 0}, {0, 0, 1}));
  // Middle (10, 6, 4): v = (0, 6, 4).
  expect_order(spfh(node_with({{9, 5, 3}, {11, 7, 5}})), {{0, 1}, {2, 0.36f}, {1, 0.16f}});
  // Behind the eye the sense does not matter.
  expect_order(spfh(node_with({{9, -7, -5}, {11, -5, -3}})), {{0, 1}, {2, 0.36f}, {1, 0.16f}});
}

TEST(Facing, ANodeAroundTheEyeTakesTheAxis) {
  const SplitOrientation spfh = facing_orientation(point_area({10, 0, 0}, {0, 3, 1}));
  const std::initializer_list<AxisChoice> axis = {{0, 1}, {2, 0.5625f}, {1, 0.0625f}};
  expect_order(spfh(node_with({{9, -1, -50}, {90, 1, 1}})), axis);
  expect_order(spfh(node_with({{9, -1, -1}, {11, 1, 1}})), axis);  // its middle is the eye
  expect_order(spfh(node_with({{10, 0, 0}, {10, 0, 0}})), axis);   // nothing but the eye
  expect_order(spfh(node_with({{10, 0, 0}, {11, 5, 5}})), axis);   // the eye on its corner
}

TEST(Facing, RefusesAreasThatAreNone) {
  EXPECT_THROW(facing_orientation(plane_area({0, 0, 0})), Error);
  EXPECT_THROW(facing_orientation(point_area({0, 0, 0}, {0, 0, 0})), Error);
}

TEST(RoundRobin, TakesTheNextAxisFirst) {
  const SplitOrientation robin = round_robin_orientation();
  for (int parent = -1; parent < 3; ++parent) {
    const AxisOrder order = robin(node_with(kUnit, parent));
    ASSERT_EQ(order.count, 3);
    EXPECT_EQ(order.choices[0].axis, (parent + 1) % 3);
    EXPECT_EQ(order.choices[1].axis, (parent + 2) % 3);
    EXPECT_EQ(order.choices[2].axis, (parent + 3) % 3);
    EXPECT_EQ(order.choices[0].quality, 1);
    EXPECT_GT(order.choices[0].quality, order.choices[1].quality);
    EXPECT_GT(order.choices[1].quality, order.choices[2].quality);
  }
}

}  // namespace
}  // namespace raygrain::test
