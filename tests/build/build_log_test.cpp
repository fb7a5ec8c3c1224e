// What builders note, by hand on tiny inputs and as sums on larger ones.
#include <algorithm>

#include "build/build_support.h"

namespace raygrain::test {
namespace {

/// Two cubes side by side along x. Surface measure (area / 4): each 1.5; both together, 4 long: 4.5.
const Prims kPair = cubes({{0, 0, 0}, {3, 0, 0}});

struct LogRow {
  const char* name;
  SplitOrientation orientation;
  PaperParameters parameters;
  bool has_fallback;
  NodeLog root;
};

PaperParameters thresholds(float quality, float acceptable, float excellent) {
  PaperParameters p;
  p.split_plane_quality_threshold = quality;
  p.acceptable_ratio = acceptable;
  p.excellent_ratio = excellent;
  return p;
}

const float kPairRatio = 3 / 4.5f;

std::vector<LogRow> rows() {
  const SplitOrientation x = fixed_axes({{0, 0.8f}, {1, 0.5f}, {2, 0.2f}}), z = fixed_axes({{2, 0.8f}, {1, 0.1f}});
  return {
      {"excellent at once", x, thresholds(0.4f, 1.3f, 0.9f), true, {0, 1, false, false, 0.8f, kPairRatio}},
      {"not excellent: the next good one, then acceptable",
       x,
       thresholds(0.4f, 1.3f, 0.1f),
       true,
       {0, 2, false, false, 0.8f, kPairRatio}},
      {"not excellent: all, where all are good",
       x,
       thresholds(0, 1.3f, 0.1f),
       true,
       {0, 3, false, false, 0.8f, kPairRatio}},
      {"not acceptable: the fallback's equal split wins",
       x,
       thresholds(0.4f, 0.5f, 0.1f),
       true,
       {0, 5, true, true, 1, kPairRatio}},
      {"not acceptable, no fallback", x, thresholds(0.4f, 0.5f, 0.1f), false, {0, 2, false, false, 0.8f, kPairRatio}},
      {"no split along z: the fallback at once",
       z,
       thresholds(0.4f, 1.3f, 0.9f),
       true,
       {0, 2, true, true, 1, kPairRatio}},
      {"nothing good enough to try", x, thresholds(0.9f, 1.3f, 0.9f), true, {0, 1, true, true, 1, kPairRatio}},
      {"inseparable along z, cut by the centroids' box",
       z,
       thresholds(0.4f, 1.3f, 0.9f),
       false,
       {0, 1, false, false, 0, kPairRatio}},
  };
}

TEST(BuildLogRow, TellsHowTheRootWasSplit) {
  for (const LogRow& row : rows()) {
    SCOPED_TRACE(row.name);
    BuildOptions options;
    options.strategy.orientation = row.orientation;
    options.parameters = row.parameters;
    if (row.has_fallback) options.fallback = BuildStrategy{};
    BuildLog log;
    const Bvh bvh = paper(kPair, options, &log);
    ASSERT_EQ(log.nodes.size(), bvh.nodes.size());
    ASSERT_EQ(bvh.nodes.size(), 3u);
    const NodeLog& root = log.nodes[0];
    EXPECT_EQ(root.axis, row.root.axis);
    EXPECT_EQ(root.orientations, row.root.orientations);
    EXPECT_EQ(root.fallback, row.root.fallback);
    EXPECT_EQ(root.forced, row.root.forced);
    EXPECT_EQ(root.quality, row.root.quality);
    EXPECT_FLOAT_EQ(root.ratio, row.root.ratio);
    EXPECT_EQ(log.nodes[1].axis, -1);
    EXPECT_EQ(log.nodes[1].orientations, 0);
  }
}

/// Four cubes: the primary cuts x (poorly: one row), the fallback cuts y.
Prims square() {
  return cubes({{0, 0, 0}, {2, 0, 0}, {0, 5, 0}, {2, 5, 0}});
}

BuildOptions better_or_fallback(SplitVerdict verdict, SplitOrientation primary, SplitOrientation fallback) {
  BuildOptions options;
  options.strategy.orientation = std::move(primary);
  options.strategy.decision = [verdict](const SplitState& state, const PaperParameters&) {
    return state.tried == 0 ? SplitVerdict::kTry : verdict;
  };
  options.fallback = BuildStrategy{};
  options.fallback->orientation = std::move(fallback);
  return options;
}

TEST(Fallback, TheBetterSplitIsKeptUnderThePrimaryMeasure) {
  const SplitOrientation x = fixed_axes({{0, 1}, {0, 1}}), y = fixed_axes({{1, 1}, {1, 1}});
  BuildLog log;
  // Cutting y is far better here.
  paper(square(), better_or_fallback(SplitVerdict::kFallBack, x, y), &log);
  EXPECT_EQ(log.nodes[0].axis, 1);
  EXPECT_TRUE(log.nodes[0].fallback);
  paper(square(), better_or_fallback(SplitVerdict::kFallBack, y, x), &log);
  EXPECT_EQ(log.nodes[0].axis, 1);
  EXPECT_FALSE(log.nodes[0].fallback);
  EXPECT_TRUE(log.nodes[0].forced);
  // ... unless the fallback replaces whatever there was, as in the published runs.
  paper(square(), better_or_fallback(SplitVerdict::kFallBackReplacing, y, x), &log);
  EXPECT_EQ(log.nodes[0].axis, 0);
  EXPECT_TRUE(log.nodes[0].fallback);
}

TEST(Fallback, ThePrimaryMeasureIsTheCurrency) {
  // Under the primary measure (extent along x) cutting x is better, whatever the fallback's surface area says.
  BuildOptions options =
      better_or_fallback(SplitVerdict::kFallBack, fixed_axes({{0, 1}, {0, 1}}), fixed_axes({{1, 1}}));
  options.strategy.measure = [](const Bounds& box) { return extent(box).x; };
  BuildLog log;
  paper(square(), options, &log);
  EXPECT_EQ(log.nodes[0].axis, 0);
  EXPECT_FALSE(log.nodes[0].fallback);
  EXPECT_FLOAT_EQ(log.nodes[0].ratio, 2.0f / 3.0f);
}

TEST(Fallback, ChildrenAreJudgedByThePrimaryMeasure) {
  BuildOptions options =
      better_or_fallback(SplitVerdict::kFallBackReplacing, fixed_axes({{0, 1}, {0, 1}}), fixed_axes({{1, 1}}));
  options.strategy.measure = [](const Bounds& box) { return extent(box).x; };
  std::vector<float> judged;
  options.strategy.stop = [&judged](const StopState& state, const PaperParameters& p) {
    judged.push_back(state.measure);
    return stop_by_parameters(state, p);
  };
  paper(square(), options);
  ASSERT_GE(judged.size(), 3u);
  EXPECT_EQ(judged[0], 3);  // the root, then its lower and upper row: 3 wide each
  EXPECT_EQ(judged[1], 3);
}

TEST(Fallback, ChildrenBelowTheNonFallbackLevelsAreJudgedByTheFallback) {
  BuildOptions options;
  options.strategy.measure = RayMeasure([](const Bounds&) { return 7.0f; });
  options.fallback = BuildStrategy{};
  options.fallback->measure = RayMeasure([](const Bounds&) { return 9.0f; });
  options.parameters.max_non_fallback_levels = 1;
  std::vector<std::pair<uint32_t, float>> judged;
  const StopRule note = [&judged](const StopState& state, const PaperParameters& p) {
    judged.emplace_back(state.node.level, state.measure);
    return stop_by_parameters(state, p);
  };
  options.strategy.stop = options.fallback->stop = note;
  paper(random_prims(40, 1), options);
  for (const auto& [level, measure] : judged) EXPECT_EQ(measure, level > 1 ? 9 : 7) << "level " << level;
  EXPECT_GT(judged.size(), 20u);
}

TEST(BuildLogSums, AgreeWithTheTree) {
  for (uint64_t seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(seed);
    const Prims prims = random_prims(200, seed);
    BuildOptions options;
    options.strategy.orientation = fixed_axes({{0, 0.8f}, {1, 0.5f}, {2, 0.2f}});
    options.fallback = BuildStrategy{};
    for (const auto build : {build_paper, build_binned}) {
      BuildLog log;
      const Bvh bvh = build(prims.bounds, prims.centroids, options, &log);
      ASSERT_EQ(log.nodes.size(), bvh.nodes.size());
      size_t inner = 0, tried = 0, forced = 0;
      for (size_t i = 0; i < bvh.nodes.size(); ++i) {
        const NodeLog& note = log.nodes[i];
        EXPECT_EQ(note.axis < 0, bvh.nodes[i].is_leaf());
        inner += bvh.nodes[i].is_leaf() ? 0 : 1;
        tried += note.orientations;
        forced += note.forced ? 1 : 0;
        if (bvh.nodes[i].is_leaf()) {
          EXPECT_FALSE(note.fallback || note.forced);
          continue;
        }
        const RayMeasure measure;
        const float children =
            measure(bvh.nodes[bvh.nodes[i].first].bounds) + measure(bvh.nodes[bvh.nodes[i].first + 1].bounds);
        EXPECT_FLOAT_EQ(note.ratio, children / measure(bvh.nodes[i].bounds));
      }
      EXPECT_EQ(inner, inner_nodes(bvh));
      if (build == build_binned) {
        EXPECT_EQ(tried, 2 * inner);  // the axes that reach the quality threshold
        EXPECT_EQ(forced, 0u);
        continue;
      }
      EXPECT_GE(tried, inner);
      EXPECT_GT(forced, 0u);
      EXPECT_LT(forced, inner);
    }
  }
}

TEST(BuildLogTimes, AreSplitIntoPartsThatAddUp) {
  const Prims prims = random_prims(3000, 1);
  for (const auto build : {build_paper, build_binned}) {
    BuildLog log;
    log.times.total = 1e9;  // a log that was used before
    log.nodes.resize(99999);
    build(prims.bounds, prims.centroids, {}, &log);
    const BuildTimes& t = log.times;
    for (const double part : {t.orientations, t.candidates, t.partition, t.stop, t.nodes}) EXPECT_GT(part, 0);
    EXPECT_LE(t.orientations + t.candidates + t.partition + t.stop + t.nodes, t.total);
    EXPECT_LT(t.total, 1e6);
  }
}

TEST(BuildLogTrees, AreTheSameWithAndWithoutALog) {
  const Prims prims = random_prims(300, 4);
  BuildLog first, second;
  for (const auto build : {build_paper, build_binned}) {
    const Bvh bare = build(prims.bounds, prims.centroids, {}, nullptr);
    EXPECT_TRUE(same_tree(bare, build(prims.bounds, prims.centroids, {}, &first)));
    build(prims.bounds, prims.centroids, {}, &second);
    ASSERT_EQ(first.nodes.size(), second.nodes.size());
    for (size_t i = 0; i < first.nodes.size(); ++i) {
      EXPECT_EQ(first.nodes[i].axis, second.nodes[i].axis);
      EXPECT_EQ(first.nodes[i].ratio, second.nodes[i].ratio);
    }
  }
}

}  // namespace
}  // namespace raygrain::test
