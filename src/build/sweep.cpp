// Full sweep: every position between two primitives, on every axis. Slow; what other builders are measured against.
#include <algorithm>
#include <array>

#include "raygrain/build.h"

#include "base/parallel.h"
#include "build/strategy.h"
#include "build/timed_build.h"
#include "build/top_down.h"

namespace raygrain {

namespace {

using builder::ActiveStrategy;
using builder::Choice;
using builder::Input;
using builder::OpenNode;

/// The best position along one axis. Keeps its memory for the next node.
class AxisSweep {
 public:
  void find(const Input& input, const ActiveStrategy& strategy, const OpenNode& node, std::span<const uint32_t> prims,
            AxisChoice axis) {
    sort(input, strategy, node, prims, axis.axis);
    sweep(input);
    choose(strategy, node, axis);
  }
  const Choice& choice() const { return choice_; }

 private:
  struct Key {
    float position;
    uint32_t prim;
  };

  void sort(const Input& input, const ActiveStrategy& strategy, const OpenNode& node, std::span<const uint32_t> prims,
            int axis) {
    keys_.clear();
    for (const uint32_t prim : prims)
      keys_.push_back({strategy.key(input.bounds[prim], input.centroids[prim], axis, node.context), prim});
    std::sort(keys_.begin(), keys_.end(), [](const Key& a, const Key& b) {
      return a.position != b.position ? a.position < b.position : a.prim < b.prim;
    });
  }

  /// Sides of every cut between different keys: left, right, left, right ...
  void sweep(const Input& input) {
    cuts_.clear();
    sides_.clear();
    Bounds side;
    for (uint32_t i = 0; i + 1 < keys_.size(); ++i) {
      side.extend(input.bounds[keys_[i].prim]);
      if (!(keys_[i].position < keys_[i + 1].position)) continue;
      cuts_.push_back(i + 1);
      sides_.push_back(side);
      sides_.emplace_back();
    }
    side = {};
    size_t i = keys_.size();
    for (size_t cut = cuts_.size(); cut-- > 0;) {
      while (i > cuts_[cut]) side.extend(input.bounds[keys_[--i].prim]);
      sides_[2 * cut + 1] = side;
    }
  }

  void choose(const ActiveStrategy& strategy, const OpenNode& node, AxisChoice axis) {
    choice_ = {};
    if (cuts_.empty()) return;
    measures_.resize(sides_.size());
    strategy.measure(sides_, measures_, node.context);
    const uint32_t count = node.context.count;
    for (size_t i = 0; i < cuts_.size(); ++i) {
      const uint32_t left = cuts_[i];
      const double cost = strategy.cost(measures_[2 * i], left, node.context) +
                          strategy.cost(measures_[2 * i + 1], count - left, node.context);
      const bool is_better = !choice_ || cost < choice_.cost ||
                             (cost == choice_.cost &&
                              std::max(left, count - left) < std::max(choice_.left_count, count - choice_.left_count));
      if (!is_better) continue;
      choice_.by = &strategy;
      choice_.axis = axis.axis;
      choice_.quality = axis.quality;
      choice_.position = keys_[left].position;
      choice_.left = sides_[2 * i];
      choice_.right = sides_[2 * i + 1];
      choice_.left_count = left;
      choice_.left_measure = measures_[2 * i];
      choice_.right_measure = measures_[2 * i + 1];
      choice_.cost = cost;
    }
  }

  std::vector<Key> keys_;
  std::vector<uint32_t> cuts_;
  std::vector<Bounds> sides_;
  std::vector<float> measures_;
  Choice choice_;
};

class SweepBuilder {
 public:
  SweepBuilder(const Input& input, const BuildOptions& options)
      : input_(input), options_(options), strategy_(options.strategy, options.parameters, options.costs) {}

  Bvh build(builder::Laps& laps, BuildLog* log) {
    builder::Splitter splitter;
    splitter.start = [this](const NodeContext& root) { strategy_.set_total(root); };
    splitter.judge = [this](uint32_t) -> const ActiveStrategy& { return strategy_; };
    splitter.choose = [this](const OpenNode& node, std::span<const uint32_t> prims, NodeLog& note) {
      return choose(node, prims, note);
    };
    return builder::build_top_down(input_, options_, splitter, laps, log);
  }

 private:
  Choice choose(const OpenNode& node, std::span<const uint32_t> prims, NodeLog& note) {
    AxisOrder admitted;
    const AxisOrder order = strategy_.axes(node.context);
    for (size_t i = 0; i < static_cast<size_t>(order.count); ++i)
      if (i == 0 || order.choices[i].quality >= options_.parameters.split_plane_quality_threshold)
        admitted.push(order.choices[i]);
    note.orientations = static_cast<uint8_t>(admitted.count);
    Choice best = best_of(node, prims, admitted);
    if (!best && options_.split_inseparable) best = last_choice(node, prims);
    if (best && options_.merge_leaves &&
        builder::is_leaf_cheaper(options_, node.context.count, node.measure,
                                 strategy_.cost(node.measure, node.context.count, node.context), best.cost))
      return {};
    return best;
  }

  Choice best_of(const OpenNode& node, std::span<const uint32_t> prims, const AxisOrder& axes) {
    constexpr size_t kManyPrims = 4096;  // axes are sorted side by side
    const auto count = static_cast<size_t>(axes.count);
    parallel_for(count, 1, prims.size() < kManyPrims ? 1 : options_.threads, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) sweeps_[i].find(input_, strategy_, node, prims, axes.choices[i]);
    });
    Choice best;
    for (size_t i = 0; i < count; ++i)
      if (const Choice& choice = sweeps_[i].choice(); choice && (!best || choice.cost < best.cost)) best = choice;
    return best;
  }

  Choice last_choice(const OpenNode& node, std::span<const uint32_t> prims) {
    AxisOrder order;
    order.push({longest_axis(builder::key_box(input_, prims, strategy_, node.context)), 0});
    if (const Choice choice = best_of(node, prims, order)) return choice;
    const bool is_large = node.context.count > std::max(options_.leaf_size, options_.parameters.max_triangles_per_leaf);
    return is_large ? builder::halve(input_, prims, strategy_, node.context) : Choice{};
  }

  const Input& input_;
  const BuildOptions& options_;
  ActiveStrategy strategy_;
  std::array<AxisSweep, 3> sweeps_;  // by place in the orientation's order
};

}  // namespace

Bvh build_sweep(std::span<const Bounds> bounds, std::span<const Vec3> centroids, const BuildOptions& options,
                BuildLog* log) {
  validate(options);
  const Input checked = builder::checked_input(bounds, centroids, options.threads);
  return builder::timed_build(checked, options, log, [&](const Input& input, builder::Laps& laps) {
    return SweepBuilder(input, options).build(laps, log);
  });
}

}  // namespace raygrain
