#include "build/bins.h"

#include <algorithm>

namespace raygrain::builder {

void AxisBins::set_equal_slices(float lo, float hi, uint32_t bins) {
  const double length = static_cast<double>(hi) - static_cast<double>(lo);
  planes_.resize(bins - 1);
  for (uint32_t i = 1; i < bins; ++i)
    planes_[i - 1] = static_cast<float>(static_cast<double>(lo) + length * (static_cast<double>(i) / bins));
  lo_ = lo;
  scale_ = length > 0 ? bins / length : 0;
  clear_slices();
}

void AxisBins::set_equal_slices_with_top(float lo, float hi, uint32_t bins) {
  set_equal_slices(lo, hi, bins);
  planes_.push_back(hi);
  clear_slices();
}

void AxisBins::use_planes() {
  scale_ = -1;
  clear_slices();
}

void AxisBins::clear_slices() {
  slices_.assign(planes_.size() + 1, Slice{});
}

size_t AxisBins::search_slice(float key) const {
  return static_cast<size_t>(std::upper_bound(planes_.begin(), planes_.end(), key) - planes_.begin());
}

/// Fills `candidates_` and `boxes_`. A plane whose lower slice is empty parts the primitives as the plane before it
/// does: it is no candidate of its own.
void AxisBins::sweep() {
  const size_t planes = planes_.size();
  suffixes_.resize(planes + 1);
  Bounds right;
  uint32_t total = 0;
  for (size_t i = planes + 1; i-- > 0;) {
    if (slices_[i].count > 0) right.extend(slices_[i].box);
    total += slices_[i].count;
    suffixes_[i] = right;
  }
  candidates_.clear();
  boxes_.clear();
  Bounds left;
  uint32_t left_count = 0;
  for (uint32_t i = 0; i < planes; ++i) {
    if (slices_[i].count == 0) continue;
    left.extend(slices_[i].box);
    left_count += slices_[i].count;
    if (left_count == total) break;
    candidates_.push_back({i, left_count});
    boxes_.push_back(left);
  }
  for (const Candidate& candidate : candidates_) boxes_.push_back(suffixes_[candidate.plane + 1]);
}

bool AxisBins::is_better(const Candidate& candidate, double cost, const Choice& best, uint32_t count, Tie tie) const {
  if (!best || cost < best.cost) return true;
  if (cost > best.cost || (tie == Tie::kLowerPlane && cost > 0)) return false;
  const auto larger_side = [count](uint32_t left) { return std::max(left, count - left); };
  return larger_side(candidate.left_count) < larger_side(best.left_count);
}

Choice AxisBins::best_plane(const ActiveStrategy& strategy, const NodeContext& node, AxisChoice axis, Tie tie) {
  sweep();
  Choice best;
  if (candidates_.empty()) return best;
  measures_.resize(boxes_.size());
  strategy.measure(boxes_, measures_, node);
  const size_t count = candidates_.size();
  for (size_t i = 0; i < count; ++i) {
    const Candidate& candidate = candidates_[i];
    const float left = measures_[i], right = measures_[count + i];
    const double cost =
        strategy.cost(left, candidate.left_count, node) + strategy.cost(right, node.count - candidate.left_count, node);
    const bool better = best && tie == Tie::kLowerPlane && strategy.has_preference()
                            ? strategy.prefers({cost, candidate.left_count, node.count - candidate.left_count},
                                               {best.cost, best.left_count, node.count - best.left_count})
                            : is_better(candidate, cost, best, node.count, tie);
    if (!better) continue;
    best = {&strategy,
            axis.axis,
            axis.quality,
            planes_[candidate.plane],
            false,
            boxes_[i],
            boxes_[count + i],
            candidate.left_count,
            left,
            right,
            cost};
  }
  return best;
}

}  // namespace raygrain::builder
