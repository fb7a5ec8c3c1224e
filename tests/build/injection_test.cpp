// Every injection point, of the strategy and of its fallback, replaced by a lambda that leaves a visible trace.
#include <algorithm>
#include <map>

#include "build/build_support.h"

namespace raygrain::test {
namespace {

const Prims kPrims = random_prims(150, 21);

/// How often each axis was cut at a regular candidate plane.
std::map<int, int> axes_used(const BuildLog& log) {
  std::map<int, int> used;
  for (const NodeLog& node : log.nodes)
    if (node.axis >= 0 && node.quality > 0) ++used[node.axis];
  return used;
}

TEST(Injection, MeasureDecidesTheAxis) {
  // Cost grows with the extent along one axis only, so cuts across it are best.
  for (int axis = 0; axis < 3; ++axis) {
    SCOPED_TRACE(axis);
    BuildOptions options;
    options.strategy.measure = [axis](const Bounds& box) { return extent(box)[axis]; };
    options.parameters.excellent_ratio = 0;
    for (const auto build : {build_paper, build_binned}) {
      BuildLog log;
      build(kPrims.bounds, kPrims.centroids, options, &log);
      EXPECT_EQ(log.nodes[0].axis, axis);
    }
  }
}

TEST(Injection, OrientationDecidesTheAxes) {
  for (int axis = 0; axis < 3; ++axis) {
    BuildOptions options;
    options.strategy.orientation = fixed_axes({{axis, 0.7f}});
    for (const auto build : {build_paper, build_binned}) {
      BuildLog log;
      build(kPrims.bounds, kPrims.centroids, options, &log);
      const auto used = axes_used(log);
      EXPECT_EQ(used.size(), 1u);
      EXPECT_EQ(used.count(axis), 1u);
      EXPECT_EQ(log.nodes[0].quality, 0.7f);
    }
  }
}

TEST(Injection, OrientationIsToldTheNode) {
  BuildOptions options;
  std::vector<NodeContext> seen;
  options.strategy.orientation = [&seen](const NodeContext& node) {
    seen.push_back(node);
    return AxisOrder{{AxisChoice{(node.parent_axis + 1) % 3, 1}, {}, {}}, 1};
  };
  BuildLog log;
  const Bvh bvh = paper(kPrims, options, &log);
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen[0].bounds, bvh.nodes[0].bounds);
  EXPECT_EQ(seen[0].count, 150u);
  EXPECT_EQ(seen[0].level, 0u);
  EXPECT_EQ(seen[0].parent_axis, -1);
  EXPECT_EQ(seen[1].level, 1u);
  EXPECT_EQ(seen[1].parent_axis, 0);
  std::vector<uint64_t> seeds;
  for (const NodeContext& node : seen) seeds.push_back(node.seed);
  const std::vector<uint64_t> first_seeds = seeds;
  std::sort(seeds.begin(), seeds.end());
  EXPECT_EQ(std::unique(seeds.begin(), seeds.end()), seeds.end());
  const auto seeds_of_run = [&](uint64_t seed) {
    seen.clear();
    options.seed = seed;
    paper(kPrims, options);
    std::vector<uint64_t> result;
    for (const NodeContext& node : seen) result.push_back(node.seed);
    return result;
  };
  EXPECT_EQ(seeds_of_run(1), first_seeds);
  EXPECT_NE(seeds_of_run(2), first_seeds);
}

TEST(Injection, CostDecidesThePlane) {
  // Only the counts are priced, and an even split is best.
  BuildOptions options;
  options.strategy.cost = [](float, uint32_t count) { return static_cast<float>(count) * static_cast<float>(count); };
  options.parameters.bins = 1024;
  for (const auto build : {build_paper, build_binned}) {
    const Bvh bvh = build(kPrims.bounds, kPrims.centroids, options, nullptr);
    EXPECT_LE(max_level(bvh), 9u);  // log2(150), and one for uneven halves
  }
}

TEST(Injection, PlanesAreTheOnlyCandidates) {
  BuildOptions options;
  options.strategy.orientation = fixed_axes({{0, 1}});
  options.split_inseparable = false;
  options.strategy.planes = [](const NodeContext& node, const Bounds& centroids, int axis, uint32_t bins,
                               std::vector<float>& planes) {
    EXPECT_EQ(axis, 0);
    EXPECT_EQ(bins, 40u);
    EXPECT_TRUE(contains(node.bounds, centroids));
    if (node.level < 2) planes = {node.level == 0 ? 3.0f : 7.0f};
  };
  for (const auto build : {build_paper, build_binned}) {
    const Bvh bvh = build(kPrims.bounds, kPrims.centroids, options, nullptr);
    ASSERT_EQ(find_defect(bvh, kPrims.bounds), std::nullopt);
    ASSERT_EQ(bvh.nodes.size(), 5u);
    const auto slab = [&](uint32_t i) {
      const float x = kPrims.centroids[bvh.prims[i]].x;
      return (x >= 3 ? 1 : 0) + (x >= 7 ? 1 : 0);
    };
    for (const Bvh::Node& node : bvh.nodes)
      for (uint32_t i = node.first; i < node.first + node.count; ++i) EXPECT_EQ(slab(i), slab(node.first));
  }
}

TEST(Injection, PlanesMayBeMany) {
  // One plane per centroid: the full sweep. It must find a split at least as cheap as any of 39 slices.
  BuildOptions options;
  options.strategy.orientation = fixed_axes({{1, 1}});
  const auto cost = [](const Bvh& bvh, size_t i) {
    const RayMeasure measure;
    size_t leaves = 0;
    std::vector<size_t> open{i};
    while (!open.empty()) {
      const Bvh::Node& node = bvh.nodes[open.back()];
      open.pop_back();
      leaves += node.count;
      if (!node.is_leaf()) open.insert(open.end(), {node.first, node.first + size_t{1}});
    }
    return static_cast<double>(measure(bvh.nodes[i].bounds)) * static_cast<double>(leaves);
  };
  const Bvh sliced = paper(kPrims, options);
  options.strategy.planes = [](const NodeContext&, const Bounds&, int axis, uint32_t, std::vector<float>& planes) {
    for (const Vec3 centroid : kPrims.centroids) planes.push_back(centroid[axis]);
    std::sort(planes.begin(), planes.end());
  };
  const Bvh swept = paper(kPrims, options);
  EXPECT_EQ(find_defect(swept, kPrims.bounds), std::nullopt);
  EXPECT_LT(cost(swept, 1) + cost(swept, 2), cost(sliced, 1) + cost(sliced, 2));
}

TEST(Injection, PartitionRuleDecidesTheSide) {
  // By the upper corner instead of the centroid: a long box goes to the other side.
  Prims prims = cubes({{0, 0, 0}, {1, 0, 0}, {8, 0, 0}, {9, 0, 0}});
  prims.add({{0, 0, 0}, {9.5f, 1, 1}});
  BuildOptions options;
  options.strategy.orientation = fixed_axes({{0, 1}});
  options.parameters.bins = 2;
  for (const auto build : {build_paper, build_binned}) {
    options.strategy.partition = nullptr;
    EXPECT_EQ(build(prims.bounds, prims.centroids, options, nullptr).nodes[1].bounds.hi.x, 9.5f);
    options.strategy.partition = [](const Bounds& box, Vec3, int axis) { return box.hi[axis]; };
    const Bvh bvh = build(prims.bounds, prims.centroids, options, nullptr);
    EXPECT_EQ(find_defect(bvh, prims.bounds), std::nullopt);
    EXPECT_EQ(bvh.nodes[1].bounds.hi.x, 2);
  }
}

TEST(Injection, DecisionSeesTheSearchAndEndsIt) {
  std::vector<SplitState> states;
  BuildOptions options;
  options.strategy.decision = [&states](const SplitState& state, const PaperParameters&) {
    states.push_back(state);
    return state.tried < 2 ? SplitVerdict::kTry : SplitVerdict::kSatisfied;
  };
  BuildLog log;
  const Bvh bvh = paper(kPrims, options, &log);
  EXPECT_EQ(log.nodes[0].orientations, 2);
  ASSERT_GE(states.size(), 3u);
  EXPECT_FALSE(states[0].has_split);
  EXPECT_EQ(states[0].ratio, kInf);
  EXPECT_EQ(states[0].node_measure, RayMeasure()(bvh.nodes[0].bounds));
  EXPECT_TRUE(states[1].has_split);
  EXPECT_GT(states[1].ratio, 0);
  EXPECT_EQ(states[1].next.axis, 1);
  EXPECT_EQ(states[2].tried, 2);
  EXPECT_LE(states[2].ratio, 2);
}

TEST(Injection, StopRuleMakesLeaves) {
  BuildOptions options;
  std::vector<StopState> states;
  options.strategy.stop = [&states](const StopState& state, const PaperParameters&) {
    states.push_back(state);
    return state.node.count <= 20;
  };
  for (const auto build : {build_paper, build_binned}) {
    states.clear();
    const Bvh bvh = build(kPrims.bounds, kPrims.centroids, options, nullptr);
    EXPECT_GT(largest_leaf(bvh), 5u);
    EXPECT_LE(largest_leaf(bvh), 20u);
    EXPECT_EQ(states[0].probability, 1);
    EXPECT_EQ(states[0].measure, RayMeasure()(bvh.nodes[0].bounds));
    EXPECT_FLOAT_EQ(states[0].cost, 150 * 1.2f);
  }
}

/// Asks for the fallback at once, everywhere.
BuildOptions always_falling_back() {
  BuildOptions options;
  options.strategy.orientation = fixed_axes({{0, 1}});
  options.strategy.decision = [](const SplitState&, const PaperParameters&) { return SplitVerdict::kFallBack; };
  options.fallback = BuildStrategy{};
  return options;
}

TEST(FallbackInjection, OrientationAndDecision) {
  BuildOptions options = always_falling_back();
  options.fallback->orientation = fixed_axes({{2, 0.9f}, {1, 0.8f}});
  options.fallback->decision = [](const SplitState& state, const PaperParameters&) {
    return state.tried == 0 ? SplitVerdict::kTry : SplitVerdict::kSatisfied;
  };
  BuildLog log;
  paper(kPrims, options, &log);
  EXPECT_EQ(axes_used(log).count(2), 1u);
  EXPECT_EQ(axes_used(log).size(), 1u);
  EXPECT_TRUE(log.nodes[0].fallback);
  EXPECT_TRUE(log.nodes[0].forced);
  EXPECT_EQ(log.nodes[0].orientations, 1);
}

TEST(FallbackInjection, MeasureAndCost) {
  BuildOptions options = always_falling_back();
  options.parameters.excellent_ratio = 0;
  options.fallback->measure = [](const Bounds& box) { return extent(box).y; };
  BuildLog log;
  paper(kPrims, options, &log);
  EXPECT_EQ(log.nodes[0].axis, 1);
  options.fallback->cost = [](float, uint32_t count) { return static_cast<float>(count * count); };
  options.parameters.bins = 1024;
  EXPECT_LE(max_level(paper(kPrims, options)), 9u);
}

TEST(FallbackInjection, PlanesAndPartition) {
  BuildOptions options = always_falling_back();
  options.fallback->planes = [](const NodeContext& node, const Bounds&, int, uint32_t, std::vector<float>& planes) {
    if (node.level == 0) planes = {5.0f};
  };
  options.fallback->partition = [](const Bounds& box, Vec3, int axis) { return box.lo[axis]; };
  options.split_inseparable = false;
  BuildLog log;
  const Bvh bvh = paper(kPrims, options, &log);
  ASSERT_EQ(bvh.nodes.size(), 3u);
  EXPECT_EQ(find_defect(bvh, kPrims.bounds), std::nullopt);
  EXPECT_GE(bvh.nodes[2].bounds.lo[log.nodes[0].axis], 5);
}

TEST(FallbackInjection, StopRuleBelowTheNonFallbackLevels) {
  BuildOptions options = always_falling_back();
  options.parameters.max_non_fallback_levels = 1;
  options.fallback->stop = [](const StopState&, const PaperParameters&) { return true; };
  EXPECT_EQ(max_level(paper(kPrims, options)), 2u);
}

TEST(FallbackInjection, FallbackHasNoFallbackOfItsOwn) {
  BuildOptions options = always_falling_back();
  options.fallback->decision = options.strategy.decision;
  options.split_inseparable = false;
  EXPECT_EQ(paper(kPrims, options).nodes.size(), 1u);
}

}  // namespace
}  // namespace raygrain::test
