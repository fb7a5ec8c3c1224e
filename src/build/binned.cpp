// Binned top-down construction after Wald, "On fast construction of SAH-based bounding volume hierarchies" (2007), with
// any measure in place of the surface area.
#include <array>

#include "raygrain/build.h"

#include "build/bins.h"
#include "build/laps.h"
#include "build/reference_builder.h"
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

/// With everything that a strategy may replace; one thread.
class BinnedBuilder {
 public:
  BinnedBuilder(const Input& input, const BuildOptions& options, builder::Laps& laps)
      : input_(input), options_(options), laps_(laps), strategy_(options.strategy, options.parameters, options.costs) {}

  Bvh build(BuildLog* log) {
    builder::Splitter splitter;
    splitter.start = [this](const NodeContext& root) { strategy_.set_total(root); };
    splitter.judge = [this](uint32_t) -> const ActiveStrategy& { return strategy_; };
    splitter.choose = [this](const OpenNode& node, std::span<const uint32_t> prims, NodeLog& note) {
      return choose(node, prims, note);
    };
    return builder::build_top_down(input_, options_, splitter, laps_, log);
  }

 private:
  Choice choose(const OpenNode& node, std::span<const uint32_t> prims, NodeLog& note) {
    laps_.lap(&BuildTimes::candidates);
    const AxisOrder order = admitted_axes(node.context);
    laps_.lap(&BuildTimes::orientations);
    note.orientations = static_cast<uint8_t>(order.count);
    fill_bins(node.context, prims, order);
    Choice best;
    for (size_t i = 0; i < static_cast<size_t>(order.count); ++i) {
      const Choice choice = bins_[i].best_plane(strategy_, node.context, order.choices[i], builder::Tie::kMoreEven);
      if (choice && (!best || choice.cost < best.cost)) best = choice;
    }
    if (!best && options_.split_inseparable)
      best = builder::split_inseparable(input_, prims, strategy_, node.context, options_, bins_[0]);
    if (best && options_.merge_leaves &&
        builder::is_leaf_cheaper(options_, node.context.count, node.measure,
                                 strategy_.cost(node.measure, node.context.count, node.context), best.cost))
      return {};
    return best;
  }

  AxisOrder admitted_axes(const NodeContext& node) const {
    const AxisOrder order = strategy_.axes(node);
    AxisOrder admitted;
    for (size_t i = 0; i < static_cast<size_t>(order.count); ++i)
      if (i == 0 || order.choices[i].quality >= options_.parameters.split_plane_quality_threshold)
        admitted.push(order.choices[i]);
    return admitted;
  }

  /// The one pass over the primitives, for all axes.
  void fill_bins(const NodeContext& node, std::span<const uint32_t> prims, const AxisOrder& order) {
    const Bounds keys = builder::key_box(input_, prims, strategy_, node);
    const auto axes = static_cast<size_t>(order.count);
    for (size_t i = 0; i < axes; ++i) set_planes(bins_[i], node, keys, order.choices[i].axis);
    for (const uint32_t prim : prims) {
      const Bounds& box = input_.bounds[prim];
      const Vec3 centroid = input_.centroids[prim];
      for (size_t i = 0; i < axes; ++i) bins_[i].add(strategy_.key(box, centroid, order.choices[i].axis, node), box);
    }
  }

  void set_planes(AxisBins& bins, const NodeContext& node, const Bounds& keys, int axis) const {
    if (!strategy_.has_planes()) return bins.set_equal_slices(keys.lo[axis], keys.hi[axis], options_.parameters.bins);
    bins.planes().clear();
    strategy_.planes(node, keys, axis, bins.planes());
    bins.use_planes();
  }

  const Input& input_;
  const BuildOptions& options_;
  builder::Laps& laps_;
  ActiveStrategy strategy_;
  std::array<AxisBins, 3> bins_;  // by place in the orientation's order
};

}  // namespace

Bvh build_binned(std::span<const Bounds> bounds, std::span<const Vec3> centroids, const BuildOptions& options,
                 BuildLog* log) {
  validate(options);
  const Input input = builder::checked_input(bounds, centroids, options.threads);
  if (builder::has_references(input, options.strategy))
    return builder::build_from_references(input, options, false, log);
  return builder::timed_build(input, options, log, [&](const Input& all, builder::Laps& laps) {
    return BinnedBuilder(all, options, laps).build(log);
  });
}

}  // namespace raygrain
