// Meister and Bittner, "Parallel reinsertion for bounding volume hierarchy optimization" (2018).
#include <algorithm>
#include <cmath>

#include "raygrain/error.h"
#include "raygrain/refine.h"

#include "base/parallel.h"
#include "build/estimate.h"
#include "build/linked_tree.h"

namespace raygrain {

namespace {

using builder::kNoNode;
using builder::LinkedTree;

struct Move {
  uint32_t node = kNoNode, target = kNoNode;
  double gain = 0;  // by which the sum of inner measures falls, were it the only move
};

/// Where one subtree would lower the sum most: branch and bound through the siblings of its ancestors.
class Search {
 public:
  Search(const LinkedTree& tree, const RayMeasure& measure) : tree_(tree), measure_(measure) {}

  Move best_move(uint32_t node) {
    best_ = {node};
    const uint32_t parent = tree_[node].parent;
    if (parent == kNoNode || tree_[parent].parent == kNoNode) return best_;
    double freed = static_cast<double>(tree_[parent].measure);
    Bounds rest;  // of the pivot without the node
    uint32_t from = node;
    for (uint32_t pivot = parent; pivot != kNoNode; pivot = tree_[pivot].parent) {
      const uint32_t other = tree_.sibling(from);
      look_below(other, node, freed);
      rest.extend(tree_[other].box);
      if (pivot != parent)
        freed += static_cast<double>(tree_[pivot].measure) - builder::checked_measure(measure_, rest);
      from = pivot;
    }
    return best_;
  }

 private:
  struct Visit {
    uint32_t node;
    double freed;  // what is left of the freed measure at this depth
  };

  void look_below(uint32_t start, uint32_t moved, double freed) {
    const Bounds& box = tree_[moved].box;
    const auto least = static_cast<double>(tree_[moved].measure);
    open_.assign(1, {start, freed});
    while (!open_.empty()) {
      const Visit visit = open_.back();
      open_.pop_back();
      if (visit.freed - least <= best_.gain) continue;
      const LinkedTree::Node& node = tree_[visit.node];
      const double gain = visit.freed - builder::checked_measure(measure_, united(node.box, box));
      if (gain > best_.gain) {
        best_.gain = gain;
        best_.target = visit.node;
      }
      const double below = gain + static_cast<double>(node.measure);
      if (node.is_leaf() || below - least <= best_.gain) continue;
      open_.push_back({node.children[1], below});
      open_.push_back({node.children[0], below});
    }
  }

  const LinkedTree& tree_;
  const RayMeasure& measure_;
  Move best_;
  std::vector<Visit> open_;
};

/// Every stride-th node, from `start` on. Best first; equal gains by node.
std::vector<Move> find_moves(const LinkedTree& tree, const RayMeasure& measure, uint32_t start, uint32_t stride,
                             unsigned threads) {
  const size_t count = start < tree.size() ? (tree.size() - start + stride - 1) / stride : 0;
  std::vector<Move> moves(count);
  parallel_for(count, 256, threads, [&](size_t begin, size_t end) {
    Search search(tree, measure);
    for (size_t i = begin; i < end; ++i) moves[i] = search.best_move(start + static_cast<uint32_t>(i) * stride);
  });
  std::erase_if(moves, [](const Move& move) { return !(move.gain > 0); });
  std::sort(moves.begin(), moves.end(),
            [](const Move& a, const Move& b) { return a.gain != b.gain ? a.gain > b.gain : a.node < b.node; });
  return moves;
}

void validate(const ReinsertOptions& options) {
  if (!(options.share > 0 && options.share <= 1))
    throw Error(ErrorCode::kUsage, "share", "value out of range", "must be in (0, 1]");
  if (!(options.costs.inner >= 0 && std::isfinite(options.costs.inner) && options.costs.triangle >= 0 &&
        std::isfinite(options.costs.triangle)))
    throw Error(ErrorCode::kUsage, "costs", "value out of range", "must be finite, 0 or more");
}

}  // namespace

ReinsertResult reinsert(Bvh& bvh, const RayMeasure& measure, const ReinsertOptions& options) {
  validate(options);
  ReinsertResult result;
  if (bvh.nodes.empty()) return result;
  LinkedTree tree(bvh, measure);
  result.cost_before = result.cost_after = estimated_cost(bvh, measure, options.costs);
  Bvh best = bvh;
  const auto stride = static_cast<uint32_t>(std::min(std::ceil(1 / static_cast<double>(options.share)), 1e9));
  uint32_t idle = 0;  // iterations in a row without a move
  for (uint32_t i = 0; i < options.iterations && idle < stride; ++i) {
    if (options.progress && !options.progress(static_cast<double>(i) / options.iterations))
      throw Error(ErrorCode::kCancelled, "reinsert", "cancelled by its caller");
    size_t moves = 0;
    for (const Move& move : find_moves(tree, measure, i % stride, stride, options.threads))
      moves += tree.move(move.node, move.target) ? 1 : 0;
    ++result.iterations;
    idle = moves == 0 ? idle + 1 : 0;
    if (moves == 0) continue;
    // Rounding, a measure that is not monotone, or a tree too deep for searches: keep what was there.
    Bvh next = tree.laid_out(bvh);
    const double cost = estimated_cost(next, measure, options.costs);
    if (!(cost < result.cost_after) || max_level(next) > kMaxTreeLevels) break;
    best = std::move(next);
    result.cost_after = cost;
    result.moves += moves;
  }
  if (result.moves > 0) bvh = std::move(best);
  if (options.progress) options.progress(1);
  return result;
}

}  // namespace raygrain
