// What builders refuse, and that user code's own exceptions come through untouched.
#include <limits>
#include <stdexcept>

#include "raygrain/error.h"

#include "build/build_support.h"

namespace raygrain::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

const Prims kPrims = random_prims(50, 3);

Error error_of(const Prims& prims, const BuildOptions& options, bool use_paper = true) {
  try {
    (use_paper ? build_paper : build_binned)(prims.bounds, prims.centroids, options, nullptr);
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error";
  return {ErrorCode::kCancelled, "", ""};
}

TEST(BadMeasure, IsRefusedWithTheNode) {
  for (const float bad : {kNan, -1.0f, kInf, -kInf})
    for (const bool use_paper : {true, false}) {
      BuildOptions options;
      options.strategy.measure = [bad](const Bounds&) { return bad; };
      const Error error = error_of(kPrims, options, use_paper);
      EXPECT_EQ(error.code, ErrorCode::kBadHeuristic);
      EXPECT_EQ(error.where.find("node at level 0 with 50 primitives in box ("), 0u) << error.where;
    }
}

TEST(BadMeasure, IsFoundDeepInTheTree) {
  for (const bool use_paper : {true, false}) {
    BuildOptions options;
    options.strategy.measure = [](const Bounds& box) { return length(extent(box)) < 3 ? kNan : 1.0f; };
    const Error error = error_of(kPrims, options, use_paper);
    EXPECT_EQ(error.code, ErrorCode::kBadHeuristic);
    EXPECT_NE(error.message.find("nan"), std::string::npos) << error.message;
  }
}

TEST(BadMeasure, TotalIsChecked) {
  for (const float bad : {kNan, -2.0f, kInf}) {
    BuildOptions options;
    options.strategy.measure = RayMeasure([](const Bounds&) { return 1.0f; }, bad);
    EXPECT_EQ(error_of(kPrims, options).code, ErrorCode::kBadHeuristic);
  }
}

TEST(BadMeasure, OfTheFallbackIsRefused) {
  BuildOptions options;
  options.strategy.decision = [](const SplitState&, const PaperParameters&) { return SplitVerdict::kFallBack; };
  options.fallback = BuildStrategy{};
  options.fallback->measure = RayMeasure([](const Bounds&) { return kNan; }, 1.0f);
  EXPECT_EQ(error_of(kPrims, options).code, ErrorCode::kBadHeuristic);
}

TEST(BadOrientation, IsRefused) {
  const auto order = [](int count, AxisChoice choice) {
    return [count, choice](const NodeContext&) { return AxisOrder{{choice, choice, choice}, count}; };
  };
  for (const bool use_paper : {true, false})
    for (const SplitOrientation& bad : std::initializer_list<SplitOrientation>{
             order(0, {0, 1}), order(4, {0, 1}), order(-1, {0, 1}), order(1, {3, 1}), order(3, {-1, 1}),
             order(1, {0, kNan}), order(2, {0, kInf})}) {
      BuildOptions options;
      options.strategy.orientation = bad;
      EXPECT_EQ(error_of(kPrims, options, use_paper).code, ErrorCode::kBadHeuristic);
    }
}

TEST(BadCandidates, AreRefused) {
  for (const std::vector<float>& bad : {std::vector<float>{2, 1}, {kNan}, {1, kInf}}) {
    BuildOptions options;
    options.strategy.planes = [&bad](const NodeContext&, const Bounds&, int, uint32_t, std::vector<float>& planes) {
      planes = bad;
    };
    for (const bool use_paper : {true, false})
      EXPECT_EQ(error_of(kPrims, options, use_paper).code, ErrorCode::kBadHeuristic);
  }
}

TEST(BadPartition, IsRefused) {
  for (const float bad : {kNan, kInf}) {
    BuildOptions options;
    options.strategy.partition = [bad](const Bounds&, Vec3, int) { return bad; };
    for (const bool use_paper : {true, false})
      EXPECT_EQ(error_of(kPrims, options, use_paper).code, ErrorCode::kBadHeuristic);
  }
}

TEST(BadCost, IsRefused) {
  BuildOptions options;
  options.strategy.cost = [](float, uint32_t) { return kNan; };
  for (const bool use_paper : {true, false})
    EXPECT_EQ(error_of(kPrims, options, use_paper).code, ErrorCode::kBadHeuristic);
}

TEST(BadInput, IsNamed) {
  Prims prims = kPrims;
  prims.centroids.pop_back();
  EXPECT_EQ(error_of(prims, {}).where, "centroids");
  prims = kPrims;
  prims.bounds[7].lo.y = kNan;
  EXPECT_EQ(error_of(prims, {}).where, "bounds[7]");
  prims.bounds[7] = {};
  EXPECT_EQ(error_of(prims, {}, false).where, "bounds[7]");
  prims = kPrims;
  prims.centroids[9].z = kInf;
  EXPECT_EQ(error_of(prims, {}).where, "centroids[9]");
  EXPECT_EQ(error_of(prims, {}).code, ErrorCode::kUsage);
}

TEST(UserExceptions, PassThrough) {
  struct Mine : std::runtime_error {
    Mine() : std::runtime_error("mine") {}
  };
  for (const auto build : {build_paper, build_binned}) {
    BuildOptions options;
    options.strategy.measure = [](const Bounds& box) -> float {
      if (length(extent(box)) < 5) throw Mine();
      return 1;
    };
    EXPECT_THROW(build(kPrims.bounds, kPrims.centroids, options, nullptr), Mine);
    options = {};
    options.strategy.orientation = [](const NodeContext&) -> AxisOrder { throw Mine(); };
    EXPECT_THROW(build(kPrims.bounds, kPrims.centroids, options, nullptr), Mine);
    options = {};
    options.strategy.stop = [](const StopState&, const PaperParameters&) -> bool { throw Mine(); };
    EXPECT_THROW(build(kPrims.bounds, kPrims.centroids, options, nullptr), Mine);
  }
}

}  // namespace
}  // namespace raygrain::test
