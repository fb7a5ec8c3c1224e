#include "build/top_down.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "base/random.h"
#include "build/monitor.h"

namespace raygrain::builder {

namespace {

constexpr size_t kProgressStep = 4096;  // primitives

/// Left primitives first; both sides keep their order, so the result depends on nothing else.
void partition(const Input& input, std::span<uint32_t> prims, const Choice& choice, const NodeContext& node,
               std::vector<uint32_t>& right) {
  if (choice.halves) return;
  right.clear();
  size_t left = 0;
  for (const uint32_t prim : prims) {
    const bool is_left = choice.by->key(input.bounds[prim], input.centroids[prim], choice.axis, node) < choice.position;
    if (is_left)
      prims[left++] = prim;
    else
      right.push_back(prim);
  }
  std::copy(right.begin(), right.end(), prims.begin() + static_cast<std::ptrdiff_t>(left));
}

}  // namespace

NodeContext root_context(const Bounds& bounds, uint32_t count, uint64_t seed) {
  NodeContext root;
  root.bounds = bounds;
  root.count = count;
  root.seed = Random(seed).next();
  return root;
}

NodeContext child_context(const NodeContext& parent, const Bounds& bounds, uint32_t count, int axis, uint64_t side) {
  return {bounds, count, parent.level + 1, axis, Random(parent.seed + side).next()};
}

Bvh build_top_down(const Input& input, const BuildOptions& options, const Splitter& splitter, Laps& laps,
                   BuildLog* log) {
  Bvh bvh;
  if (input.bounds.empty()) return bvh;
  bvh.prims.resize(input.bounds.size());
  std::iota(bvh.prims.begin(), bvh.prims.end(), 0u);
  bvh.nodes.reserve(2 * input.bounds.size() - 1);
  bvh.nodes.resize(1);

  Bounds all;
  for (const Bounds& box : input.bounds) all.extend(box);
  OpenNode root{root_context(all, static_cast<uint32_t>(input.bounds.size()), options.seed)};
  Monitor monitor(options.progress, input.bounds.size());
  size_t finished = 0, told = 0;
  splitter.start(root.context);
  root.measure = splitter.judge(0).measure(root.context.bounds, root.context);
  std::vector<OpenNode> open{root};
  std::vector<uint32_t> scratch;
  std::vector<NodeLog> notes(1);
  laps.lap(&BuildTimes::nodes);

  while (!open.empty()) {
    const OpenNode node = open.back();
    open.pop_back();
    const NodeContext& context = node.context;
    bvh.nodes[node.index] = {context.bounds, node.first, context.count};
    finished = node.first;  // depth first: all before this node are in leaves
    if (finished >= told + kProgressStep || context.level == 0) {
      monitor.finish(finished - told);
      told = finished;
    }

    // Leaf by rule?
    const bool is_leaf = context.count < 2 || context.level >= kMaxTreeLevels ||
                         splitter.judge(context.level).stops(context, node.measure);
    laps.lap(&BuildTimes::stop);
    if (is_leaf) continue;

    // Leaf for want of a split?
    const std::span<uint32_t> prims{bvh.prims.data() + node.first, context.count};
    NodeLog& note = notes[log ? node.index : 0];
    note = {};
    const Choice choice = splitter.choose(node, prims, note);
    laps.lap(&BuildTimes::candidates);
    if (!choice) {
      note.fallback = note.forced = false;
      continue;
    }
    note.axis = static_cast<int8_t>(choice.axis);
    note.quality = choice.quality;
    note.ratio = children_ratio(choice, node.measure);
    const bool forced = note.forced, fallback = note.fallback;  // `notes` grows below

    // Split.
    partition(input, prims, choice, context, scratch);
    laps.lap(&BuildTimes::partition);
    const auto first_child = static_cast<uint32_t>(bvh.nodes.size());
    bvh.nodes[node.index].first = first_child;
    bvh.nodes[node.index].count = 0;
    bvh.nodes.resize(bvh.nodes.size() + 2);
    if (log) notes.resize(bvh.nodes.size());
    OpenNode left{child_context(context, choice.left, choice.left_count, choice.axis, 1), choice.left_measure,
                  first_child, node.first};
    OpenNode right{child_context(context, choice.right, context.count - choice.left_count, choice.axis, 2),
                   choice.right_measure, first_child + 1, node.first + choice.left_count};
    // The next level may be judged by another strategy: hand on the measure that the children will be judged by.
    const ActiveStrategy& next = splitter.judge(context.level + 1);
    if (&next != &splitter.judge(context.level)) {
      left.measure = next.measure(left.context.bounds, left.context);
      right.measure = next.measure(right.context.bounds, right.context);
    }
    if (const ActiveStrategy& own = splitter.judge(context.level); splitter.hands_down && own.has_hand_down())
      std::tie(left.measure, right.measure) =
          own.hand_down({context, choice.left, choice.right, left.measure, right.measure, forced, fallback});
    open.push_back(right);
    open.push_back(left);
    laps.lap(&BuildTimes::nodes);
  }
  if (log) log->peak_bytes = memory_bytes(bvh) + scratch.capacity() * sizeof(uint32_t);
  bvh.nodes.shrink_to_fit();
  monitor.finish(input.bounds.size() - told);
  if (log) log->nodes = std::move(notes);
  return bvh;
}

Bounds key_box(const Input& input, std::span<const uint32_t> prims, const ActiveStrategy& strategy,
               const NodeContext& node) {
  Bounds box;
  if (!strategy.has_partition()) {
    for (const uint32_t prim : prims) box.extend(input.centroids[prim]);
    return box;
  }
  for (const uint32_t prim : prims) {
    const Bounds& bounds = input.bounds[prim];
    const Vec3 centroid = input.centroids[prim];
    box.extend(Vec3{strategy.key(bounds, centroid, 0, node), strategy.key(bounds, centroid, 1, node),
                    strategy.key(bounds, centroid, 2, node)});
  }
  return box;
}

Choice halve(const Input& input, std::span<const uint32_t> prims, const ActiveStrategy& strategy,
             const NodeContext& node) {
  Choice choice;
  choice.by = &strategy;
  choice.axis = longest_axis(node.bounds);
  choice.halves = true;
  choice.left_count = node.count / 2;
  for (const uint32_t prim : prims.first(choice.left_count)) choice.left.extend(input.bounds[prim]);
  for (const uint32_t prim : prims.subspan(choice.left_count)) choice.right.extend(input.bounds[prim]);
  choice.left_measure = strategy.measure(choice.left, node);
  choice.right_measure = strategy.measure(choice.right, node);
  choice.cost = strategy.cost(choice.left_measure, choice.left_count, node) +
                strategy.cost(choice.right_measure, node.count - choice.left_count, node);
  return choice;
}

Choice split_inseparable(const Input& input, std::span<const uint32_t> prims, const ActiveStrategy& strategy,
                         const NodeContext& node, const BuildOptions& options, AxisBins& bins) {
  const Bounds keys = key_box(input, prims, strategy, node);
  const int axis = longest_axis(keys);
  if (keys.lo[axis] < keys.hi[axis]) {
    bins.set_equal_slices_with_top(keys.lo[axis], keys.hi[axis], options.parameters.bins);
    for (const uint32_t prim : prims) {
      const Bounds& box = input.bounds[prim];
      bins.add(strategy.key(box, input.centroids[prim], axis, node), box);
    }
    return bins.best_plane(strategy, node, {axis, 0}, Tie::kLowerPlane);
  }
  // Coincident keys: a pile that fits into a leaf is left alone; a larger one must not become a huge leaf.
  const bool is_large = node.count > std::max(options.leaf_size, options.parameters.max_triangles_per_leaf);
  return is_large ? halve(input, prims, strategy, node) : Choice{};
}

float children_ratio(const Choice& choice, float node_measure) {
  if (!(node_measure > 0)) return kInf;
  return static_cast<float>((static_cast<double>(choice.left_measure) + static_cast<double>(choice.right_measure)) /
                            static_cast<double>(node_measure));
}

}  // namespace raygrain::builder
