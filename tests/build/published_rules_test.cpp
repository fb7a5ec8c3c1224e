// The injection points that the rules of the published runs need: skipping an orientation, the axis tried last, which
// of two planes is better, and the measures that children start with.
#include <limits>

#include "raygrain/error.h"

#include "build/build_support.h"

namespace raygrain::test {
namespace {

BuildOptions with_fallback(std::vector<AxisChoice> primary, std::vector<AxisChoice> fallback) {
  BuildOptions options;
  options.strategy.orientation = fixed_axes(std::move(primary));
  options.fallback = BuildStrategy{};
  options.fallback->orientation = fixed_axes(std::move(fallback));
  return options;
}

TEST(PublishedRules, SkippedOrientationsAreNotTried) {
  const Prims prims = random_prims(100, 3);
  BuildOptions options;
  options.strategy.orientation = fixed_axes({{0, 1}, {1, 1}, {2, 1}});
  options.strategy.decision = [](const SplitState& state, const PaperParameters&) {
    return state.next.axis == 1 ? SplitVerdict::kTry : SplitVerdict::kSkip;
  };
  options.split_inseparable = false;
  BuildLog log;
  const Bvh tree = paper(prims, options, &log);
  ASSERT_EQ(find_defect(tree, prims.bounds), std::nullopt);
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    if (tree.nodes[i].is_leaf()) continue;
    EXPECT_EQ(log.nodes[i].axis, 1);
    EXPECT_EQ(log.nodes[i].orientations, 1);
  }
}

TEST(PublishedRules, TheFallbackKnowsTheAxisTriedLast) {
  BuildOptions options = with_fallback({{2, 1}, {0, 0.1f}}, {{2, 1}, {1, 0.9f}, {0, 0.1f}});
  options.strategy.decision = [](const SplitState& state, const PaperParameters&) {
    EXPECT_EQ(state.last_axis, state.tried == 0 ? -1 : 2);
    return state.tried == 0 ? SplitVerdict::kTry : SplitVerdict::kFallBackReplacing;
  };
  options.fallback->decision = [](const SplitState& state, const PaperParameters&) {
    if (state.tried > 0) return SplitVerdict::kSatisfied;
    EXPECT_EQ(state.last_axis, 2);
    return state.next.axis == state.last_axis ? SplitVerdict::kSkip : SplitVerdict::kTry;
  };
  options.split_inseparable = false;
  BuildLog log;
  const Bvh tree = paper(random_prims(60, 4), options, &log);
  EXPECT_EQ(log.nodes[0].axis, 1);
  EXPECT_EQ(log.nodes[0].orientations, 2);
  EXPECT_TRUE(log.nodes[0].forced && log.nodes[0].fallback);
}

TEST(PublishedRules, PreferenceDecidesBetweenPlanes) {
  // Nothing costs anything: by default the most even plane wins; here the first, then the last.
  const Prims prims = cubes({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {6, 0, 0}, {8, 0, 0}, {10, 0, 0}});
  for (const bool first : {true, false}) {
    BuildOptions options;
    options.strategy.measure = [](const Bounds&) { return 0.0f; };
    options.strategy.orientation = fixed_axes({{0, 1}});
    options.strategy.preference = [first](const PlanePrice& candidate, const PlanePrice& best) {
      EXPECT_EQ(candidate.left_count + candidate.right_count, best.left_count + best.right_count);
      EXPECT_GT(candidate.left_count, best.left_count);  // ascending planes
      return !first;
    };
    const Bvh tree = paper(prims, options);
    const Bvh::Node& left = tree.nodes[tree.nodes[0].first];
    EXPECT_EQ(left.is_leaf(), first) << "the first plane cuts off one cube, the last leaves one";
  }
}

TEST(PublishedRules, ChildrenStartWithTheMeasuresHandedDown) {
  BuildOptions options = with_fallback({{0, 1}}, {{1, 1}});
  options.strategy.hand_down = [](const SplitOutcome& split) {
    EXPECT_FALSE(split.forced);
    EXPECT_EQ(split.left_measure, RayMeasure()(split.left));
    return std::pair(std::numeric_limits<float>::infinity(), 7.0f);
  };
  int left = 0, right = 0;
  options.strategy.stop = [&](const StopState& state, const PaperParameters&) {
    left += state.measure == std::numeric_limits<float>::infinity() ? 1 : 0;
    right += state.measure == 7 ? 1 : 0;
    return state.node.count < 2;
  };
  const Bvh tree = paper(random_prims(50, 5), options);
  EXPECT_GT(left, 10);
  EXPECT_GT(right, 10);
  EXPECT_EQ(find_defect(tree, random_prims(50, 5).bounds), std::nullopt);
}

TEST(PublishedRules, HandDownIsToldOfFallbacksAndChecked) {
  BuildOptions options = with_fallback({{0, 1}, {2, 0}}, {{1, 1}});
  options.strategy.decision = [](const SplitState& state, const PaperParameters&) {
    return state.tried == 0 ? SplitVerdict::kTry : SplitVerdict::kFallBackReplacing;
  };
  int told = 0;
  options.strategy.hand_down = [&](const SplitOutcome& split) {
    EXPECT_TRUE(split.forced);
    told += split.fallback ? 1 : 0;
    return std::pair(1.0f, 1.0f);
  };
  paper(random_prims(50, 6), options);
  EXPECT_GT(told, 10);
  for (const float bad : {-1.0f, std::numeric_limits<float>::quiet_NaN()}) {
    options.strategy.hand_down = [bad](const SplitOutcome&) { return std::pair(1.0f, bad); };
    try {
      paper(random_prims(50, 6), options);
      ADD_FAILURE() << bad;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kBadHeuristic);
      EXPECT_NE(error.where.find("level 0"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace raygrain::test
