// Algorithm 1 of "Ray Distribution Aware Heuristics for Bounding Volume Hierarchies Construction in Ray Tracing"
// (2024), section 8.1, with slices instead of one repartition per plane.
#include <algorithm>

#include "raygrain/build.h"

#include "build/bins.h"
#include "build/laps.h"
#include "build/strategy.h"
#include "build/timed_build.h"
#include "build/top_down.h"

namespace raygrain {

namespace {

using builder::ActiveStrategy;
using builder::AxisBins;
using builder::Choice;
using builder::Input;
using builder::OpenNode;

class PaperBuilder {
 public:
  PaperBuilder(const Input& input, const BuildOptions& options, builder::Laps& laps)
      : input_(input),
        options_(options),
        laps_(laps),
        primary_(options.strategy, options.parameters, options.costs),
        fallback_(options.fallback ? *options.fallback : options.strategy, options.parameters, options.costs) {}

  Bvh build(BuildLog* log) {
    builder::Splitter splitter;
    splitter.start = [this](const NodeContext& root) {
      primary_.set_total(root);
      fallback_.set_total(root);
    };
    splitter.judge = [this](uint32_t level) -> const ActiveStrategy& { return judge(level); };
    splitter.choose = [this](const OpenNode& node, std::span<const uint32_t> prims, NodeLog& note) {
      return choose(node, prims, note);
    };
    splitter.hands_down = true;
    return builder::build_top_down(input_, options_, splitter, laps_, log);
  }

 private:
  /// The best split along the orientations that were tried, and the verdict that ended the search.
  struct Search {
    Choice best;
    SplitVerdict verdict = SplitVerdict::kSatisfied;
  };

  const ActiveStrategy& judge(uint32_t level) const {
    return options_.fallback && level > options_.parameters.max_non_fallback_levels ? fallback_ : primary_;
  }

  Choice choose(const OpenNode& node, std::span<const uint32_t> prims, NodeLog& note) {
    const ActiveStrategy& own = judge(node.context.level);
    note.fallback = &own == &fallback_;
    last_axis_ = -1;
    Search search = try_orientations(own, node.context, node.measure, prims, note);
    const bool falls_back =
        search.verdict == SplitVerdict::kFallBack || search.verdict == SplitVerdict::kFallBackReplacing;
    // The fallback strategy has no fallback of its own.
    if (falls_back && options_.fallback && &own == &primary_) fall_back(node.context, prims, search, note);
    if (!search.best && options_.split_inseparable)
      search.best = builder::split_inseparable(input_, prims, own, node.context, options_, bins_);
    return search.best;
  }

  /// The loop of Algorithm 1 over the orientations of one node.
  Search try_orientations(const ActiveStrategy& strategy, const NodeContext& node, float node_measure,
                          std::span<const uint32_t> prims, NodeLog& note) {
    Search search;
    laps_.lap(&BuildTimes::candidates);
    const AxisOrder order = strategy.axes(node);
    laps_.lap(&BuildTimes::orientations);
    SplitState state;
    state.node = node;
    state.node_measure = node_measure;
    state.last_axis = last_axis_;
    for (const AxisChoice& next : std::span(order.choices).first(static_cast<size_t>(order.count))) {
      state.next = next;
      search.verdict = strategy.decide(state);
      laps_.lap(&BuildTimes::orientations);
      if (search.verdict == SplitVerdict::kSkip) continue;
      if (search.verdict != SplitVerdict::kTry) break;
      ++note.orientations;
      ++state.tried;
      state.last_axis = last_axis_ = state.next.axis;
      const Choice choice = best_along(strategy, node, state.next, prims);
      if (choice && (!search.best || choice.cost < search.best.cost)) search.best = choice;
      if (search.best) {
        state.has_split = true;
        state.ratio = builder::children_ratio(search.best, node_measure);
      }
      laps_.lap(&BuildTimes::candidates);
    }
    return search;
  }

  /// ComputeBinnedSplittingPlanesPositions, SplitPrimitives and ComputeCost for all planes along one axis.
  Choice best_along(const ActiveStrategy& strategy, const NodeContext& node, AxisChoice axis,
                    std::span<const uint32_t> prims) {
    if (strategy.has_planes()) {
      bins_.planes().clear();
      strategy.planes(node, builder::key_box(input_, prims, strategy, node), axis.axis, bins_.planes());
      bins_.use_planes();
    } else {
      bins_.set_equal_slices(node.bounds.lo[axis.axis], node.bounds.hi[axis.axis], options_.parameters.bins);
    }
    for (const uint32_t prim : prims) {
      const Bounds& box = input_.bounds[prim];
      bins_.add(strategy.key(box, input_.centroids[prim], axis.axis, node), box);
    }
    return bins_.best_plane(strategy, node, axis, builder::Tie::kLowerPlane);
  }

  /// Lets the fallback strategy split, too, and keeps the better split in the one currency of the primary strategy.
  /// (The published program let the fallback win always: kFallBackReplacing.) Equal costs go to the fallback: a primary
  /// measure that sees no difference, e.g. boxes without projected area, has nothing to say.
  void fall_back(const NodeContext& node, std::span<const uint32_t> prims, Search& search, NodeLog& note) {
    note.forced = true;
    const float node_measure = fallback_.measure(node.bounds, node);
    Choice other = try_orientations(fallback_, node, node_measure, prims, note).best;
    if (!other) return;
    other.left_measure = primary_.measure(other.left, node);
    other.right_measure = primary_.measure(other.right, node);
    other.cost = primary_.cost(other.left_measure, other.left_count, node) +
                 primary_.cost(other.right_measure, node.count - other.left_count, node);
    const bool replaces =
        search.verdict == SplitVerdict::kFallBackReplacing || !search.best || other.cost <= search.best.cost;
    if (!replaces) return;
    search.best = other;
    note.fallback = true;
  }

  const Input& input_;
  const BuildOptions& options_;
  builder::Laps& laps_;
  ActiveStrategy primary_, fallback_;
  AxisBins bins_;
  int last_axis_ = -1;  // tried last at the open node
};

}  // namespace

Bvh build_paper(std::span<const Bounds> bounds, std::span<const Vec3> centroids, const BuildOptions& options,
                BuildLog* log) {
  validate(options);
  const Input checked = builder::checked_input(bounds, centroids, options.threads);
  return builder::timed_build(checked, options, log, [&](const Input& input, builder::Laps& laps) {
    return PaperBuilder(input, options, laps).build(log);
  });
}

}  // namespace raygrain
