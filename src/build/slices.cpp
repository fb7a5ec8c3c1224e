#include "build/slices.h"

#include <limits>

namespace raygrain::builder {

SliceGrid::SliceGrid(const PackedBox& keys, uint32_t count) : slices(count) {
  lo = keys.lower;
  lo[3] = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float candidate = static_cast<float>(count) / keys.length(axis);
    // Not for lengths of 0 or so tiny that the quotient overflows.
    scale[axis] = candidate <= std::numeric_limits<float>::max() ? candidate : 0;
  }
}

void Slices::clear(uint32_t slices) {
  slices_ = slices;
  boxes_.assign(3 * slices, PackedBox{});
  counts_.assign(3 * slices, 0);
}

void Slices::add(const SliceGrid& grid, std::span<const Reference> references) {
  const float top = static_cast<float>(slices_ - 1);
  const FourFloats last{top, top, top, top};
  PackedBox* const boxes = boxes_.data();
  uint32_t* const counts = counts_.data();
  const size_t stride = slices_;
  for (const Reference& reference : references) {
    const FourInts slice = truncated(lesser((reference.key - grid.lo) * grid.scale, last));
    const PackedBox box = reference.box;
    const size_t x = static_cast<size_t>(slice[0]), y = stride + static_cast<size_t>(slice[1]),
                 z = 2 * stride + static_cast<size_t>(slice[2]);
    boxes[x].extend(box);
    boxes[y].extend(box);
    boxes[z].extend(box);
    ++counts[x];
    ++counts[y];
    ++counts[z];
  }
}

void Slices::merge(const Slices& other) {
  for (size_t i = 0; i < boxes_.size(); ++i) {
    boxes_[i].extend(other.boxes_[i]);
    counts_[i] += other.counts_[i];
  }
}

/// Adds a candidate for each plane above a filled slice, but for the last filled one. First the left sides upwards,
/// then the right sides downwards.
void Slices::sweep(const AxisChoice& axis, uint32_t choice, uint32_t total) {
  const PackedBox* const boxes = boxes_.data() + static_cast<size_t>(axis.axis) * slices_;
  const uint32_t* const counts = counts_.data() + static_cast<size_t>(axis.axis) * slices_;
  const size_t first = candidates_.size();
  PackedBox side;
  uint32_t left_count = 0, slice = 0;
  for (;; ++slice) {
    if (counts[slice] == 0) continue;
    side.extend(boxes[slice]);
    left_count += counts[slice];
    if (left_count == total) break;
    candidates_.push_back({choice, slice, left_count});
    sides_.push_back(side.unpacked());
    sides_.emplace_back();
  }
  side = {};
  for (size_t i = candidates_.size(); i-- > first;) {
    for (; slice > candidates_[i].slice; --slice)
      if (counts[slice] > 0) side.extend(boxes[slice]);
    sides_[2 * i + 1] = side.unpacked();
  }
}

Cut Slices::best_cut(const ActiveStrategy& strategy, const NodeContext& node, const AxisOrder& order,
                     const SliceGrid& grid) {
  candidates_.clear();
  sides_.clear();
  for (uint32_t i = 0; i < static_cast<uint32_t>(order.count); ++i)
    if (grid.scale[order.choices[i].axis] > 0) sweep(order.choices[i], i, node.count);
  Cut best;
  if (candidates_.empty()) return best;
  measures_.resize(sides_.size());
  strategy.measure(sides_, measures_, node);
  size_t winner = candidates_.size();
  uint32_t larger_side = 0;
  for (size_t i = 0; i < candidates_.size(); ++i) {
    const uint32_t left = candidates_[i].left_count, right = node.count - left, larger = std::max(left, right);
    const double cost =
        static_cast<double>(measures_[2 * i]) * left + static_cast<double>(measures_[2 * i + 1]) * right;
    if (!(cost < best.cost || (cost == best.cost && larger < larger_side))) continue;
    winner = i;
    best.cost = cost;
    larger_side = larger;
  }
  if (winner == candidates_.size()) return best;
  const Candidate& candidate = candidates_[winner];
  const AxisChoice& axis = order.choices[candidate.choice];
  return {Cut::Kind::kKeys,
          axis.axis,
          axis.quality,
          grid.lo[axis.axis],
          grid.scale[axis.axis],
          static_cast<float>(candidate.slice + 1),
          0,
          sides_[2 * winner],
          sides_[2 * winner + 1],
          candidate.left_count,
          node.count - candidate.left_count,
          measures_[2 * winner],
          measures_[2 * winner + 1],
          best.cost};
}

}  // namespace raygrain::builder
