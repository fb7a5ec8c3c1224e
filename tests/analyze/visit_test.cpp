#include <gtest/gtest.h>

#include "raygrain/analyze.h"

#include "analyze/small_scenes.h"

namespace raygrain {
namespace {

TEST(VisitNodes, ParentsFirstLeftFirstThenTheEnd) {
  const Bvh bvh = test::five_nodes();
  std::vector<uint32_t> order, parents, levels;
  int ended = 0;
  visit_nodes(
      bvh,
      [&](const NodeVisit& visit) {
        EXPECT_EQ(ended, 0);
        EXPECT_EQ(visit.node, &bvh.nodes[visit.index]);
        order.push_back(visit.index);
        parents.push_back(visit.parent);
        levels.push_back(visit.level);
      },
      [&] { ++ended; });
  EXPECT_EQ(order, (std::vector<uint32_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(parents, (std::vector<uint32_t>{kNoTriangle, 0, 0, 2, 2}));
  EXPECT_EQ(levels, (std::vector<uint32_t>{0, 1, 1, 2, 2}));
  EXPECT_EQ(ended, 1);
}

TEST(VisitNodes, OrderFollowsTheTreeNotTheArray) {
  Bvh bvh;  // the left child of the root is inner, and its children stand last
  bvh.nodes = {test::inner_node({}, 1), test::inner_node({}, 3), test::leaf_node({}, 0, 1), test::leaf_node({}, 1, 1),
               test::leaf_node({}, 2, 1)};
  std::vector<uint32_t> order;
  visit_nodes(bvh, [&](const NodeVisit& visit) { order.push_back(visit.index); });
  EXPECT_EQ(order, (std::vector<uint32_t>{0, 1, 3, 4, 2}));
}

TEST(VisitNodes, DeepChainsNeedNoRecursion) {
  constexpr uint32_t kDepth = 100000;
  Bvh bvh;
  for (uint32_t i = 0; i < kDepth; ++i) {
    if (i > 0)
      bvh.nodes.back() = test::inner_node({}, 2 * i + 1);
    else
      bvh.nodes.push_back(test::inner_node({}, 1));
    bvh.nodes.push_back(test::leaf_node({}, i, 1));
    bvh.nodes.push_back(test::leaf_node({}, i, 1));
  }
  uint32_t deepest = 0, count = 0;
  visit_nodes(bvh, [&](const NodeVisit& visit) {
    deepest = std::max(deepest, visit.level);
    ++count;
  });
  EXPECT_EQ(deepest, kDepth);
  EXPECT_EQ(count, 2 * kDepth + 1);
}

TEST(VisitNodes, EmptyTreeStillEnds) {
  int ended = 0;
  visit_nodes(
      Bvh{}, [](const NodeVisit&) { FAIL(); }, [&] { ++ended; });
  EXPECT_EQ(ended, 1);
}

TEST(VisitNodes, TopLevelOnceEach) {
  const std::vector<ConvexRegion> regions{box_region({{0, 0, 0}, {1, 1, 1}}), box_region({{3, 3, 3}, {4, 4, 4}})};
  const TopLevel octree(regions, {TopLevelKind::kOctree, 3});
  std::vector<const TopLevel::Node*> seen;
  int ended = 0;
  visit_nodes(
      octree,
      [&](const TopLevel::Node& node, uint32_t level) {
        EXPECT_LE(level, 3u);
        EXPECT_EQ(level == 0, seen.empty());
        seen.push_back(&node);
      },
      [&] { ++ended; });
  EXPECT_EQ(ended, 1);
  EXPECT_EQ(seen.size(), octree.nodes().size());
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(std::adjacent_find(seen.begin(), seen.end()), seen.end());
}

TEST(NodeTable, CostsAddUpToTheEstimate) {
  const Bvh bvh = test::five_nodes();
  const RayMeasure measure;
  const AreaGeometry area(test::sun_over({0, 0, 1}, 100, 100));
  BuildLog log;
  log.nodes.resize(5);
  log.nodes[0] = {.axis = 2, .orientations = 3, .fallback = true, .forced = true, .quality = 0.5f, .ratio = 1.25f};
  const NodeTable table = tabulate_nodes(bvh, measure, &area, &log);
  ASSERT_EQ(table.rows.size(), 5u);
  const auto column = [&](const char* name) {
    const auto it = std::find(table.columns.begin(), table.columns.end(), name);
    EXPECT_NE(it, table.columns.end()) << name;
    return static_cast<size_t>(it - table.columns.begin());
  };
  double cost = 0;
  for (const auto& row : table.rows) {
    ASSERT_EQ(row.size(), table.columns.size());
    cost += row[column("cost")];
  }
  EXPECT_DOUBLE_EQ(cost, analyze(bvh, measure).estimated_cost);
  EXPECT_EQ(table.rows[0][column("parent")], -1);
  EXPECT_EQ(table.rows[0][column("first_child")], 1);
  EXPECT_EQ(table.rows[1][column("first_child")], -1);
  EXPECT_EQ(table.rows[1][column("triangles")], 2);
  EXPECT_EQ(table.rows[4][column("parent")], 2);
  EXPECT_EQ(table.rows[4][column("hi_x")], 8);
  EXPECT_EQ(table.rows[0][column("axis")], 2);
  EXPECT_EQ(table.rows[0][column("ratio")], 1.25);
  EXPECT_EQ(table.rows[0][column("forced")], 1);
  EXPECT_TRUE(std::isnan(table.rows[1][column("axis")]));
  EXPECT_TRUE(std::isnan(table.rows[0][column("overlap")]));
  EXPECT_EQ(table.rows[1][column("overlap")], 0);  // 0-2 and 3-8 do not touch
}

TEST(NodeTable, WithoutAreaAndLog) {
  const NodeTable table = tabulate_nodes(test::five_nodes(), RayMeasure{}, nullptr, nullptr);
  ASSERT_EQ(table.rows.size(), 5u);
  EXPECT_EQ(table.rows[0].size(), table.columns.size());
  EXPECT_TRUE(std::isnan(table.rows[4].back()));
  EXPECT_TRUE(tabulate_nodes(Bvh{}, RayMeasure{}, nullptr, nullptr).rows.empty());
}

}  // namespace
}  // namespace raygrain
