// Each of the ten parameters of Table 1 changes the tree as it says.
#include <algorithm>

#include "build/build_support.h"

namespace raygrain::test {
namespace {

/// Judges a node by what the default strategy (surface area) says.
struct Judged {
  float measure, probability, cost;
};
Judged judge(const Bvh::Node& node, const Bvh& bvh, uint32_t count) {
  const RayMeasure measure;
  const float m = measure(node.bounds), total = measure.total(bvh.nodes[0].bounds);
  return {m, m / total, m / total * static_cast<float>(count) * CostModel{}.triangle};
}

/// Triangles below each node.
std::vector<uint32_t> counts(const Bvh& bvh) {
  std::vector<uint32_t> result(bvh.nodes.size());
  for (size_t i = bvh.nodes.size(); i-- > 0;) {
    const Bvh::Node& node = bvh.nodes[i];
    result[i] = node.is_leaf() ? node.count : result[node.first] + result[node.first + 1];
  }
  return result;
}

/// A leaf limit acts iff no inner node is below it, and some leaf of two or more is.
template <class Value>
void expect_limit(const Bvh& bvh, float limit, Value value) {
  const std::vector<uint32_t> count = counts(bvh);
  int made = 0;
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    const float v = value(judge(bvh.nodes[i], bvh, count[i]));
    if (!bvh.nodes[i].is_leaf())
      EXPECT_GE(v, limit) << "node " << i;
    else if (count[i] > 1) {
      EXPECT_LT(v, limit) << "node " << i;
      ++made;
    }
  }
  EXPECT_GT(made, 0);
}

const Prims kPrims = random_prims(400, 11);

TEST(Parameters, MaxLeafCost) {
  BuildOptions options;
  options.parameters.max_leaf_cost = 0.05f;
  expect_limit(paper(kPrims, options), 0.05f, [](const Judged& j) { return j.cost; });
}

TEST(Parameters, MaxLeafArea) {
  BuildOptions options;
  options.parameters.max_leaf_area = 4;
  expect_limit(paper(kPrims, options), 4, [](const Judged& j) { return j.measure; });
}

TEST(Parameters, MaxLeafHitProbability) {
  BuildOptions options;
  options.parameters.max_leaf_hit_probability = 0.03f;
  expect_limit(paper(kPrims, options), 0.03f, [](const Judged& j) { return j.probability; });
}

TEST(Parameters, MaxTrianglesPerLeaf) {
  for (const uint32_t limit : {0u, 1u, 2u, 3u, 9u, 401u}) {
    SCOPED_TRACE(limit);
    BuildOptions options;
    options.parameters.max_triangles_per_leaf = limit;
    const Bvh bvh = paper(kPrims, options);
    EXPECT_EQ(find_defect(bvh, kPrims.bounds), std::nullopt);
    const std::vector<uint32_t> count = counts(bvh);
    for (size_t i = 0; i < bvh.nodes.size(); ++i) {
      if (bvh.nodes[i].is_leaf())
        EXPECT_LT(count[i], std::max(limit, 2u));
      else
        EXPECT_GE(count[i], limit);
    }
  }
}

TEST(Parameters, MaxLevels) {
  for (const uint32_t limit : {0u, 1u, 4u, 100u}) {
    SCOPED_TRACE(limit);
    BuildOptions options;
    options.parameters.max_levels = limit;
    const Bvh bvh = paper(kPrims, options);
    EXPECT_EQ(find_defect(bvh, kPrims.bounds), std::nullopt);
    if (limit < 100)
      EXPECT_EQ(max_level(bvh), limit);
    else
      EXPECT_EQ(largest_leaf(bvh), 1u);
  }
}

TEST(Parameters, Bins) {
  // Four cubes, gaps at 1/8, 1/2 and 7/8 of the box. Two slices offer the middle only; with all prices equal but the
  // lowest plane first, eight slices cut off the first cube.
  const Prims prims = cubes({{0, 0, 0}, {5, 0, 0}, {10, 0, 0}, {15, 0, 0}});
  BuildOptions options;
  options.strategy.cost = [](float, uint32_t) { return 1.0f; };
  options.strategy.orientation = fixed_axes({{0, 1}});
  options.parameters.bins = 2;
  EXPECT_EQ(paper(prims, options).nodes[1].bounds.hi.x, 6);
  options.parameters.bins = 8;
  EXPECT_EQ(paper(prims, options).nodes[1].bounds.hi.x, 1);
}

/// A fallback that shows: it cuts across z only, which the primary never does.
BuildOptions with_fallback() {
  BuildOptions options;
  options.strategy.orientation = fixed_axes({{0, 1}, {1, 0.3f}});
  options.fallback = BuildStrategy{};
  options.fallback->orientation = fixed_axes({{2, 1}});
  return options;
}

TEST(Parameters, MaxNonFallbackLevels) {
  BuildOptions options = with_fallback();
  options.parameters.acceptable_ratio = kInf;
  options.parameters.max_non_fallback_levels = 2;
  BuildLog log;
  const Bvh bvh = paper(kPrims, options, &log);
  std::vector<uint32_t> level(bvh.nodes.size(), 0);
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    if (bvh.nodes[i].is_leaf()) continue;
    level[bvh.nodes[i].first] = level[bvh.nodes[i].first + 1] = level[i] + 1;
    EXPECT_EQ(log.nodes[i].fallback, level[i] > 2) << "level " << level[i];
    EXPECT_FALSE(log.nodes[i].forced);
    if (log.nodes[i].quality > 0) {
      EXPECT_EQ(log.nodes[i].axis == 2, level[i] > 2) << "level " << level[i];
    }
  }
  EXPECT_GT(max_level(bvh), 4u);
}

TEST(Parameters, SplitPlaneQualityThreshold) {
  BuildOptions options = with_fallback();
  options.parameters.acceptable_ratio = options.parameters.excellent_ratio = 0;
  const auto uses_axis = [&](int8_t axis) {
    BuildLog log;
    paper(kPrims, options, &log);
    return std::any_of(log.nodes.begin(), log.nodes.end(),
                       [axis](const NodeLog& node) { return node.axis == axis && node.quality > 0; });
  };
  options.parameters.split_plane_quality_threshold = 0.4f;
  EXPECT_FALSE(uses_axis(1));
  options.parameters.split_plane_quality_threshold = 0.3f;
  EXPECT_TRUE(uses_axis(1));
}

size_t forced(const BuildOptions& options) {
  BuildLog log;
  paper(kPrims, options, &log);
  return static_cast<size_t>(
      std::count_if(log.nodes.begin(), log.nodes.end(), [](const NodeLog& node) { return node.forced; }));
}

TEST(Parameters, AcceptableRatio) {
  BuildOptions options = with_fallback();
  options.parameters.acceptable_ratio = 1000;
  const size_t seldom = forced(options);
  options.parameters.acceptable_ratio = 1.1f;
  const size_t often = forced(options);
  EXPECT_LT(seldom, often);
}

TEST(Parameters, ExcellentRatio) {
  BuildOptions options;
  options.strategy.orientation = all_axes_orientation();
  BuildLog patient, hasty;
  options.parameters.excellent_ratio = 0;
  paper(kPrims, options, &patient);
  for (size_t i = 0; i < patient.nodes.size(); ++i)
    EXPECT_EQ(patient.nodes[i].orientations, patient.nodes[i].axis >= 0 ? 3 : 0) << "node " << i;
  options.parameters.excellent_ratio = kInf;
  paper(kPrims, options, &hasty);
  EXPECT_EQ(hasty.nodes[0].orientations, 1);
  EXPECT_EQ(hasty.nodes[0].axis, 0);
}

}  // namespace
}  // namespace raygrain::test
