#include <gtest/gtest.h>

#include "raygrain/analyze.h"
#include "raygrain/heuristics.h"

#include "analyze/small_scenes.h"
#include "build/estimate.h"

namespace raygrain {
namespace {

RayMeasure width_measure(std::optional<float> total = std::nullopt) {
  return RayMeasure([](const Bounds& box) { return extent(box).x; }, total);
}

TEST(TreeStats, CountedByHand) {
  const TreeStats stats = analyze(test::five_nodes(), width_measure(), {.inner = 2, .triangle = 1});
  EXPECT_DOUBLE_EQ(stats.estimated_cost, 2.0 + 2.0 / 8 * 2 + 5.0 / 8 * 2 + 1.0 / 8 * 1 + 4.0 / 8 * 3);
  EXPECT_EQ(stats.nodes, 5u);
  EXPECT_EQ(stats.leaves, 3u);
  EXPECT_EQ(stats.triangles, 6u);
  EXPECT_DOUBLE_EQ(stats.triangles_per_leaf, 2.0);
  EXPECT_EQ(stats.max_triangles_per_leaf, 3u);
  EXPECT_EQ(stats.max_level, 2u);
  EXPECT_DOUBLE_EQ(stats.mean_leaf_depth, (1.0 + 2 + 2) / 3);
  EXPECT_NEAR(stats.small_child_ratio, (2.0 / 8 + 1.0 / 5) / 2, 1e-7);
  EXPECT_NEAR(stats.large_child_ratio, (5.0 / 8 + 4.0 / 5) / 2, 1e-7);
  EXPECT_EQ(stats.memory_bytes, memory_bytes(test::five_nodes()));
  EXPECT_EQ(stats.paper_memory_bytes, 5u * 40 + 6u * 4);
}

TEST(TreeStats, TotalMakesProbabilitiesAbsoluteAndAtMostOne) {
  const CostModel costs{.inner = 2, .triangle = 1};
  const double rooted = analyze(test::five_nodes(), width_measure(), costs).estimated_cost;
  EXPECT_DOUBLE_EQ(analyze(test::five_nodes(), width_measure(16), costs).estimated_cost, rooted / 2);
  EXPECT_DOUBLE_EQ(analyze(test::five_nodes(), width_measure(0.5f), costs).estimated_cost, 2.0 + 2 + 2 + 1 + 3);
}

TEST(TreeStats, AnyMeasurePricesTheSameTree) {
  Bvh bvh = test::five_nodes();
  const RayMeasure along_x = directional_measure({1, 0, 0});
  // Seen along x, all boxes are the unit square.
  EXPECT_DOUBLE_EQ(analyze(bvh, along_x, {.inner = 2, .triangle = 1}).estimated_cost, 2.0 * 2 + 6);
  EXPECT_DOUBLE_EQ(analyze(bvh, along_x).small_child_ratio, 1.0);
}

TEST(TreeStats, MeasureOfNothingCostsNothing) {
  const TreeStats stats = analyze(test::five_nodes(), RayMeasure([](const Bounds&) { return 0.0f; }));
  EXPECT_EQ(stats.estimated_cost, 0);
  EXPECT_EQ(stats.small_child_ratio, 0);
  EXPECT_EQ(stats.large_child_ratio, 0);
}

// The accelerator orders areas by the same number.
TEST(TreeStats, EstimateIsTheAccelerators) {
  const auto thirds = [](const Bounds& box) { return extent(box).x / 3; };
  for (const float total : {3.0f, 7.0f, 11.0f, 13.3f}) {
    const RayMeasure measure(thirds, total);
    EXPECT_EQ(analyze(test::five_nodes(), measure).estimated_cost, estimated_cost(test::five_nodes(), measure));
  }
}

TEST(TreeStats, SmallestTrees) {
  const TreeStats none = analyze(Bvh{}, RayMeasure{});
  EXPECT_EQ(none.nodes, 0u);
  EXPECT_EQ(none.estimated_cost, 0);
  EXPECT_EQ(none.triangles_per_leaf, 0);

  Bvh leaf;
  leaf.nodes = {test::leaf_node({{0, 0, 0}, {1, 1, 1}}, 0, 3)};
  leaf.prims = {2, 1, 0};
  const TreeStats one = analyze(leaf, RayMeasure{}, {.inner = 2, .triangle = 1.5f});
  EXPECT_DOUBLE_EQ(one.estimated_cost, 4.5);
  EXPECT_EQ(one.max_level, 0u);
  EXPECT_EQ(one.mean_leaf_depth, 0);
}

TEST(PaperMemory, ExamplesOfSection9_6) {
  const size_t leaves = size_t{1} << 20;  // 21 levels, two triangles per leaf: "about 92.27 MB"
  EXPECT_EQ(paper_memory_bytes(2 * leaves - 1, 2 * leaves), (leaves - 1) * 40 + leaves * 48);
  EXPECT_EQ(paper_memory_bytes(InfluenceArea{"", PlaneArea{}, 0.01f}), 184u);
  EXPECT_EQ(paper_memory_bytes(InfluenceArea{"", PointArea{}, 0.01f}), 336u);
  EXPECT_EQ(paper_octree_bytes(1, 1), 60u);
}

TEST(BuildStats, FromTheLog) {
  BuildLog log;
  log.nodes.resize(5);
  log.nodes[0] = {.axis = 0, .orientations = 3, .fallback = true, .forced = true};
  log.nodes[1] = {.orientations = 2};                               // tried in vain: a leaf
  log.nodes[2] = {.axis = 1, .orientations = 1, .fallback = true};  // by its level, not by the decision
  log.times.total = 1.5;
  const BuildStats stats = analyze_build(test::five_nodes(), log);
  EXPECT_DOUBLE_EQ(stats.orientations_per_node, 6.0 / 2);
  EXPECT_DOUBLE_EQ(stats.fallback_share, 1.0 / 2);
  EXPECT_EQ(stats.times.total, 1.5);
  EXPECT_EQ(analyze_build(Bvh{}, {}).orientations_per_node, 0);
}

}  // namespace
}  // namespace raygrain
