// Figure 9 and Table 1 as functions: every verdict by hand, every leaf rule at its edge, every option's range.
#include <limits>

#include "raygrain/error.h"

#include "build/build_support.h"

namespace raygrain::test {
namespace {

struct DecisionRow {
  const char* name;
  bool has_split;
  float ratio, next_quality;
  SplitVerdict verdict;
};

// Thresholds of Table 1: excellent 0.9, acceptable 1.3, quality 0.4.
const DecisionRow kDecisions[] = {
    {"nothing yet, good orientation", false, kInf, 0.8f, SplitVerdict::kTry},
    {"nothing yet, orientation at the threshold", false, kInf, 0.4f, SplitVerdict::kTry},
    {"nothing yet, poor orientation", false, kInf, 0.39f, SplitVerdict::kFallBack},
    {"excellent", true, 0.5f, 1.0f, SplitVerdict::kSatisfied},
    {"just excellent", true, 0.9f, 1.0f, SplitVerdict::kSatisfied},
    {"acceptable, good orientation left", true, 0.91f, 0.4f, SplitVerdict::kTry},
    {"acceptable, poor orientation left", true, 1.2f, 0.3f, SplitVerdict::kSatisfied},
    {"just acceptable", true, 1.3f, 0.3f, SplitVerdict::kSatisfied},
    {"bad, good orientation left", true, 1.5f, 0.5f, SplitVerdict::kTry},
    {"bad, poor orientation left", true, 1.31f, 0.3f, SplitVerdict::kFallBack},
    {"ratio unknown, poor orientation left", true, kInf, 0.3f, SplitVerdict::kFallBack},
};

TEST(Decision, FollowsFigureNine) {
  for (const DecisionRow& row : kDecisions) {
    SplitState state;
    state.has_split = row.has_split;
    state.ratio = row.ratio;
    state.next.quality = row.next_quality;
    EXPECT_EQ(decide_split(state, {}), row.verdict) << row.name;
  }
}

TEST(Decision, UsesAllThreeThresholds) {
  SplitState state;
  state.has_split = true;
  state.ratio = 1.0f;
  state.next.quality = 0.3f;
  PaperParameters p;
  EXPECT_EQ(decide_split(state, p), SplitVerdict::kSatisfied);
  p.acceptable_ratio = 0.95f;
  EXPECT_EQ(decide_split(state, p), SplitVerdict::kFallBack);
  p.split_plane_quality_threshold = 0.2f;
  EXPECT_EQ(decide_split(state, p), SplitVerdict::kTry);
  p.excellent_ratio = 1;
  EXPECT_EQ(decide_split(state, p), SplitVerdict::kSatisfied);
}

StopState stop_state(uint32_t count, uint32_t level) {
  StopState state;
  state.node.count = count;
  state.node.level = level;
  state.measure = 10;
  state.probability = 0.5f;
  state.cost = 3;
  return state;
}

TEST(Stop, HoldsStrictlyBelowEachLimit) {
  const StopState state = stop_state(5, 7);
  PaperParameters p;
  EXPECT_FALSE(stop_by_parameters(state, p));
  p.max_leaf_cost = 3;
  p.max_leaf_area = 10;
  p.max_leaf_hit_probability = 0.5f;
  p.max_triangles_per_leaf = 5;
  p.max_levels = 8;
  EXPECT_FALSE(stop_by_parameters(state, p));
  PaperParameters q = p;
  q.max_leaf_cost = 3.01f;
  EXPECT_TRUE(stop_by_parameters(state, q));
  q = p, q.max_leaf_area = 10.1f;
  EXPECT_TRUE(stop_by_parameters(state, q));
  q = p, q.max_leaf_hit_probability = 0.51f;
  EXPECT_TRUE(stop_by_parameters(state, q));
  q = p, q.max_triangles_per_leaf = 6;
  EXPECT_TRUE(stop_by_parameters(state, q));
  q = p, q.max_levels = 7;
  EXPECT_TRUE(stop_by_parameters(state, q));
}

TEST(Stop, TableOneStopsBelowTwoTrianglesAndAtLevelHundred) {
  EXPECT_TRUE(stop_by_parameters(stop_state(1, 0), {}));
  EXPECT_FALSE(stop_by_parameters(stop_state(2, 99), {}));
  EXPECT_TRUE(stop_by_parameters(stop_state(2, 100), {}));
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct BadOption {
  const char* field;
  void (*spoil)(BuildOptions&);
};

const BadOption kBadOptions[] = {
    {"max_leaf_cost", [](BuildOptions& o) { o.parameters.max_leaf_cost = -1; }},
    {"max_leaf_cost", [](BuildOptions& o) { o.parameters.max_leaf_cost = kNan; }},
    {"max_leaf_area", [](BuildOptions& o) { o.parameters.max_leaf_area = -1; }},
    {"max_leaf_hit_probability", [](BuildOptions& o) { o.parameters.max_leaf_hit_probability = kNan; }},
    {"max_levels", [](BuildOptions& o) { o.parameters.max_levels = kMaxTreeLevels + 1; }},
    {"bins", [](BuildOptions& o) { o.parameters.bins = 1; }},
    {"bins", [](BuildOptions& o) { o.parameters.bins = 4097; }},
    {"split_plane_quality_threshold", [](BuildOptions& o) { o.parameters.split_plane_quality_threshold = 1.1f; }},
    {"split_plane_quality_threshold", [](BuildOptions& o) { o.parameters.split_plane_quality_threshold = kNan; }},
    {"acceptable_ratio", [](BuildOptions& o) { o.parameters.acceptable_ratio = -0.1f; }},
    {"excellent_ratio", [](BuildOptions& o) { o.parameters.excellent_ratio = kNan; }},
    {"costs.inner", [](BuildOptions& o) { o.costs.inner = -1; }},
    {"costs.triangle", [](BuildOptions& o) { o.costs.triangle = kInf; }},
    {"leaf_size", [](BuildOptions& o) { o.leaf_size = 0; }},
};

TEST(Options, OutOfRangeAreNamed) {
  EXPECT_NO_THROW(validate(BuildOptions{}));
  for (const BadOption& bad : kBadOptions) {
    SCOPED_TRACE(bad.field);
    BuildOptions options;
    bad.spoil(options);
    for (const auto build : {build_paper, build_binned}) {
      try {
        build({}, {}, options, nullptr);
        ADD_FAILURE() << "accepted";
      } catch (const Error& error) {
        EXPECT_EQ(error.code, ErrorCode::kUsage);
        EXPECT_EQ(error.where, bad.field);
        EXPECT_FALSE(error.hint.empty());
      }
    }
  }
}

TEST(Options, EdgesOfTheRangesAreAllowed) {
  BuildOptions options;
  options.parameters = {kInf, kInf, 1, 0, kMaxTreeLevels, 4096, 0, 1, kInf, kInf};
  EXPECT_NO_THROW(validate(options));
  options.parameters.bins = 2;
  options.parameters.split_plane_quality_threshold = 0;
  options.costs = {0, 0};
  EXPECT_NO_THROW(validate(options));
}

}  // namespace
}  // namespace raygrain::test
