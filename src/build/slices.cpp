#include "build/slices.h"

#include <limits>
#include <numeric>

#include "base/check.h"

namespace raygrain::builder {

namespace {
constexpr float kLess = 1 - 0x1p-20f;  // whatever is rounded, the topmost key stays below the end of the last slice
}

SliceGrid::SliceGrid(const KeyBox& keys, uint32_t count) : slices(count) {
  for (int axis = 0; axis < 3; ++axis) {
    lo.at[axis] = keys.lo.at[axis];
    const float length = keys.length(axis), candidate = static_cast<float>(count) * kLess / length;
    // Not for lengths of 0, of either sign, or so tiny that the quotient overflows.
    scale.at[axis] = length > 0 && candidate <= std::numeric_limits<float>::max() ? candidate : 0;
  }
}

void CutCandidates::clear(size_t room) {
  size_ = 0;
  if (planes_.size() >= room) return;
  planes_.resize(room);
  sides_.resize(2 * room);
  measures_.resize(2 * room);
  costs_.resize(room);
}

Cut CutCandidates::cheapest(const ActiveStrategy& strategy, const NodeContext& node, const AxisOrder& order) {
  Cut best;
  if (size_ == 0) return best;
  strategy.measure({sides_.data(), 2 * size_}, {measures_.data(), 2 * size_}, node);
  for (size_t i = 0; i < size_; ++i) {
    const uint32_t left = planes_[i].left_count, right = node.count - left;
    costs_[i] = static_cast<double>(measures_[2 * i]) * left + static_cast<double>(measures_[2 * i + 1]) * right;
    best.cost = std::min(best.cost, costs_[i]);
  }
  size_t winner = 0;
  uint32_t larger_side = node.count;
  for (size_t i = 0; i < size_; ++i) {
    if (costs_[i] != best.cost) continue;
    const uint32_t larger = std::max(planes_[i].left_count, node.count - planes_[i].left_count);
    if (larger >= larger_side) continue;
    winner = i;
    larger_side = larger;
  }
  const Plane& plane = planes_[winner];
  const AxisChoice& axis = order.choices[plane.choice];
  best.kind = Cut::Kind::kKeys;
  best.axis = axis.axis;
  best.quality = axis.quality;
  best.limit = plane.limit;
  best.left = sides_[2 * winner];
  best.right = sides_[2 * winner + 1];
  best.left_count = plane.left_count;
  best.right_count = node.count - plane.left_count;
  best.left_measure = measures_[2 * winner];
  best.right_measure = measures_[2 * winner + 1];
  return best;
}

void Slices::clear(uint32_t slices) {
  slices_ = slices;
  boxes_.assign(size_t{3} * slices, PackedBox{});
  counts_.assign(size_t{3} * slices, 0);
}

/// Some references at a time: first where they go, then there. Neighbours in the list are often in the same slice, and
/// one would wait for the other, so each follows one from the other half.
template <class Reference>
void Slices::add(const SliceGrid& grid, std::span<const Reference> references) {
  constexpr size_t kAtOnce = 256;
  const SliceGrid at = grid;
  PackedBox* const boxes = boxes_.data();
  uint32_t* const counts = counts_.data();
  const size_t stride = slices_;
  std::array<FourInts, kAtOnce> places;
  for (size_t begin = 0; begin < references.size(); begin += kAtOnce) {
    const Reference* const some = references.data() + begin;
    const size_t count = std::min(kAtOnce, references.size() - begin), half = count / 2;
    for (size_t k = 0; k < count; ++k) {
      RAYGRAIN_LANES
      for (int i = 0; i < 4; ++i)
        places[k].at[i] = static_cast<int32_t>((some[k].key(i) - at.lo.at[i]) * at.scale.at[i]);
    }
    const auto put = [&](size_t k) {
      const auto slice = [&](int axis) { return static_cast<size_t>(static_cast<uint32_t>(places[k].at[axis])); };
      const size_t x = slice(0), y = stride + slice(1), z = 2 * stride + slice(2);
      boxes[x].extend(some[k].box);
      boxes[y].extend(some[k].box);
      boxes[z].extend(some[k].box);
      ++counts[x];
      ++counts[y];
      ++counts[z];
    };
    for (size_t k = 0; k < half; ++k) {
      put(k);
      put(half + k);
    }
    if (count > 2 * half) put(count - 1);
  }
}

template <class Reference>
void Slices::add_along(int axis, const SliceGrid& grid, std::span<const Reference> references) {
  const float lo = grid.lo.at[axis], scale = grid.scale.at[axis];
  PackedBox* const boxes = boxes_.data() + static_cast<size_t>(axis) * slices_;
  uint32_t* const counts = counts_.data() + static_cast<size_t>(axis) * slices_;
  for (const Reference& reference : references) {
    const auto slice =
        static_cast<size_t>(static_cast<uint32_t>(static_cast<int32_t>((reference.key(axis) - lo) * scale)));
    boxes[slice].extend(reference.box);
    ++counts[slice];
  }
}

void Slices::merge(const Slices& other) {
  for (size_t i = 0; i < boxes_.size(); ++i) {
    boxes_[i].extend(other.boxes_[i]);
    counts_[i] += other.counts_[i];
  }
}

size_t Slices::count_below(int axis, uint32_t end) const {
  const auto first = counts_.begin() + static_cast<std::ptrdiff_t>(static_cast<size_t>(axis) * slices_);
  return std::accumulate(first, first + end, size_t{0});
}

/// Adds a candidate for each plane above a filled slice, but for the last slice: first the left sides upwards, then the
/// right sides downwards. The box of the keys is exact: the least is in the first slice and the greatest in the last,
/// so no side is empty. A plane above an empty slice is overwritten by the next: to jump past it would take longer.
void Slices::sweep(int axis, uint32_t choice, CutCandidates& candidates) const {
  const PackedBox* const boxes = boxes_.data() + static_cast<size_t>(axis) * slices_;
  const uint32_t* const counts = counts_.data() + static_cast<size_t>(axis) * slices_;
  RAYGRAIN_CHECK(counts[0] > 0 && counts[slices_ - 1] > 0);
  size_t candidate = candidates.size();
  PackedBox side;
  uint32_t left_count = 0;
  for (uint32_t slice = 0; slice + 1 < slices_; ++slice) {
    side.extend(boxes[slice]);
    left_count += counts[slice];
    candidates.set_left(candidate, {choice, static_cast<float>(slice + 1), left_count}, side);
    candidate += counts[slice] > 0 ? 1 : 0;
  }
  candidates.resize(candidate);
  side = boxes[slices_ - 1];
  for (uint32_t slice = slices_ - 1; slice-- > 0;) {
    candidates.set_right(candidate - 1, side);
    candidate -= counts[slice] > 0 ? 1 : 0;
    side.extend(boxes[slice]);
  }
}

Cut Slices::best_cut(const ActiveStrategy& strategy, const NodeContext& node, const AxisOrder& order,
                     const SliceGrid& grid, CutCandidates& candidates) const {
  candidates.clear(size_t{3} * slices_);
  for (uint32_t i = 0; i < static_cast<uint32_t>(order.count); ++i)
    if (grid.scale.at[order.choices[i].axis] > 0) sweep(order.choices[i].axis, i, candidates);
  Cut best = candidates.cheapest(strategy, node, order);
  best.lo = grid.lo.at[best.axis];
  best.scale = grid.scale.at[best.axis];
  return best;
}

template <class Reference>
Cut best_cut_of_small(std::span<const Reference> references, const ActiveStrategy& strategy, const NodeContext& node,
                      const AxisOrder& order, CutCandidates& candidates) {
  candidates.clear(size_t{3} * kSmallNode);
  const size_t count = references.size();
  std::array<const Reference*, kSmallNode> sorted{};
  for (uint32_t choice = 0; choice < static_cast<uint32_t>(order.count); ++choice) {
    const int axis = order.choices[choice].axis;
    std::array<float, kSmallNode> keys{};
    std::array<size_t, kSmallNode> places{};
    for (size_t i = 0; i < count; ++i) {
      keys[i] = references[i].key(axis);
      for (size_t k = 0; k < i; ++k) {  // equal keys keep their order; without jumps
        const size_t is_less = keys[i] < keys[k] ? 1 : 0;
        places[k] += is_less;
        places[i] += 1 - is_less;
      }
    }
    for (size_t i = 0; i < count; ++i) sorted[places[i]] = &references[i];
    const size_t first = candidates.size();
    PackedBox side;
    for (uint32_t i = 1; i < count; ++i) {
      side.extend(sorted[i - 1]->box);
      if (sorted[i - 1]->key(axis) < sorted[i]->key(axis)) candidates.add_left({choice, sorted[i]->key(axis), i}, side);
    }
    side = {};
    size_t candidate = candidates.size();
    for (size_t i = count; candidate > first; --i) {
      side.extend(sorted[i - 1]->box);
      if (candidates.plane(candidate - 1).left_count + 1 == i) candidates.set_right(--candidate, side);
    }
    if (count == 2 && candidate < candidates.size()) break;  // two can be parted in one way only
  }
  Cut best = candidates.cheapest(strategy, node, order);
  best.scale = 1;
  return best;
}

template void Slices::add(const SliceGrid&, std::span<const Reference>);
template void Slices::add(const SliceGrid&, std::span<const KeyedReference>);
template void Slices::add_along(int, const SliceGrid&, std::span<const Reference>);
template void Slices::add_along(int, const SliceGrid&, std::span<const KeyedReference>);
template Cut best_cut_of_small(std::span<const Reference>, const ActiveStrategy&, const NodeContext&, const AxisOrder&,
                               CutCandidates&);
template Cut best_cut_of_small(std::span<const KeyedReference>, const ActiveStrategy&, const NodeContext&,
                               const AxisOrder&, CutCandidates&);

}  // namespace raygrain::builder
