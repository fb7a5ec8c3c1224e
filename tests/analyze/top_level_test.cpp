#include <gtest/gtest.h>

#include "raygrain/analyze.h"

#include "analyze/small_scenes.h"

namespace raygrain {
namespace {

std::vector<ConvexRegion> two_boxes() {
  return {box_region({{0, 0, 0}, {1, 1, 1}}), box_region({{3, 0, 0}, {4, 1, 1}})};
}

TEST(TopLevelStats, ListByHand) {
  const std::vector<ConvexRegion> regions = two_boxes();
  const std::vector<Vec3> points{{0.5f, 0.5f, 0.5f}, {3.5f, 0.5f, 0.5f}, {2, 0.5f, 0.5f}, {9, 9, 9}};
  const TopLevel list(regions, {.kind = TopLevelKind::kList});
  const TopLevelStats stats = analyze(list, regions, points);
  EXPECT_EQ(stats.nodes, 0u);
  EXPECT_EQ(stats.leaves, 0u);
  EXPECT_DOUBLE_EQ(stats.areas_per_leaf, 2);
  EXPECT_DOUBLE_EQ(stats.false_candidates, (1.0 + 1 + 2 + 2) / 4);
  EXPECT_EQ(stats.memory_bytes, list.memory_bytes());
  EXPECT_EQ(stats.paper_memory_bytes, 8u);
  EXPECT_GT(stats.query_seconds, 0);
  EXPECT_EQ(stats.build_seconds, 0);
}

TEST(TopLevelStats, OctreeAgainstItsNodes) {
  std::vector<ConvexRegion> regions = two_boxes();
  regions.push_back(AreaGeometry(test::lamp_over({1, 2, 3}, 40, 30)).region());
  std::vector<Vec3> points;
  Random random(4);
  for (int i = 0; i < 500; ++i) {
    const auto uniform = [&] { return static_cast<float>(random.uniform(-22, 22)); };
    points.push_back({uniform(), uniform(), uniform()});
  }
  const TopLevelOptions options{TopLevelKind::kOctree, 4};
  const TopLevelStats stats = analyze_top_level(regions, options, points);
  const TopLevel octree(regions, options);
  size_t leaves = 0, listed = 0, wrong = 0;
  visit_nodes(octree, [&](const TopLevel::Node& node, uint32_t) {
    leaves += node.first_child == 0 ? 1 : 0;
    listed += node.regions;
  });
  for (const Vec3 point : points) {
    for (const uint32_t region : octree.regions_at(point)) wrong += contains(regions[region], point) ? 0 : 1;
  }
  EXPECT_EQ(stats.nodes, octree.nodes().size());
  EXPECT_EQ(stats.leaves, leaves);
  EXPECT_EQ(stats.leaves, (stats.nodes - 1) / 8 * 7 + 1);
  EXPECT_DOUBLE_EQ(stats.areas_per_leaf, static_cast<double>(listed) / static_cast<double>(leaves));
  EXPECT_DOUBLE_EQ(stats.false_candidates, static_cast<double>(wrong) / 500);
  EXPECT_EQ(stats.paper_memory_bytes, 56 * stats.nodes + 4 * listed);
  EXPECT_GT(stats.build_seconds, 0);
}

TEST(TopLevelStats, SharperWithMoreLevels) {
  const std::vector<ConvexRegion> regions{AreaGeometry(test::lamp_over({1, 2, 3}, 40, 30)).region(),
                                          AreaGeometry(test::sun_over({-1, 2, 0}, 5, 5)).region()};
  std::vector<Vec3> points;
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const auto uniform = [&] { return static_cast<float>(random.uniform(-20, 20)); };
    points.push_back({uniform(), uniform(), uniform()});
  }
  const double list = analyze_top_level(regions, {TopLevelKind::kList, 0}, points).false_candidates;
  const double coarse = analyze_top_level(regions, {TopLevelKind::kOctree, 2}, points).false_candidates;
  const double fine = analyze_top_level(regions, {TopLevelKind::kOctree, 5}, points).false_candidates;
  EXPECT_LT(coarse, list);
  EXPECT_LT(fine, coarse);
}

TEST(TopLevelStats, Nothing) {
  const TopLevelStats stats = analyze_top_level({}, {}, {});
  EXPECT_EQ(stats.areas_per_leaf, 0);
  EXPECT_EQ(stats.false_candidates, 0);
}

}  // namespace
}  // namespace raygrain
