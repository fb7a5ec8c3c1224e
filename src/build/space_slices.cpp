#include "build/space_slices.h"

#include <cmath>

namespace raygrain::builder {

namespace {

/// The part of a reference's primitive between two planes: within the reference's box, whatever the callback says.
Bounds part_between(const Reference& reference, int axis, float lo, float hi, const ClipPrimitive& clip) {
  Bounds box = reference.box.unpacked();
  box.lo[axis] = std::max(box.lo[axis], lo);
  box.hi[axis] = std::min(box.hi[axis], hi);
  return intersected(box, clip(reference.id(), box));
}

Reference with_box(const Reference& reference, const Bounds& box) {
  return Reference::of(box, center(box), reference.id());
}

}  // namespace

SpaceGrid::SpaceGrid(const Bounds& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<size_t>(axis);
    const double lo = static_cast<double>(box.lo[axis]), length = static_cast<double>(box.hi[axis]) - lo;
    for (size_t i = 0; i < kPlanes; ++i)
      planes_[at][i] = static_cast<float>(lo + length * (static_cast<double>(i + 1) / kSlices));
    const auto scale = static_cast<float>(kSlices / length);
    lo_[at] = box.lo[axis];
    scale_[at] = std::isfinite(scale) && scale > 0 ? scale : 0;
  }
}

size_t SpaceGrid::guess(int axis, float x) const {
  const auto at = static_cast<size_t>(axis);
  const float place = (x - lo_[at]) * scale_[at];
  return place >= static_cast<float>(kPlanes) ? kPlanes : (place > 0 ? static_cast<size_t>(place) : 0);
}

size_t SpaceGrid::planes_up_to(int axis, float x) const {
  size_t count = guess(axis, x);
  while (count < kPlanes && plane(axis, count) <= x) ++count;
  while (count > 0 && plane(axis, count - 1) > x) --count;
  return count;
}

size_t SpaceGrid::planes_below(int axis, float x) const {
  size_t count = guess(axis, x);
  while (count < kPlanes && plane(axis, count) < x) ++count;
  while (count > 0 && plane(axis, count - 1) >= x) --count;
  return count;
}

void SpaceSlices::clear() {
  for (auto& axis : slices_) axis.fill(Slice{});
}

void SpaceSlices::add(const SpaceGrid& grid, const AxisOrder& order, std::span<const Reference> references,
                      const ClipPrimitive& clip) {
  for (const Reference& reference : references)
    for (size_t i = 0; i < static_cast<size_t>(order.count); ++i) {
      const int axis = order.choices[i].axis;
      if (!grid.has(axis)) continue;
      auto& slices = slices_[static_cast<size_t>(axis)];
      const size_t first = grid.planes_up_to(axis, reference.box.lo(axis));
      const size_t last = std::max(first, grid.planes_below(axis, reference.box.hi(axis)));
      ++slices[first].entries;
      ++slices[last].exits;
      if (first == last) {
        slices[first].box.extend(reference.box);
        continue;
      }
      for (size_t slice = first; slice <= last; ++slice) {
        const float lo = slice == first ? -kInf : grid.plane(axis, slice - 1);
        const float hi = slice == last ? kInf : grid.plane(axis, slice);
        const Bounds part = part_between(reference, axis, lo, hi, clip);
        if (!is_empty(part)) slices[slice].box.extend(PackedBox::of(part));
      }
    }
}

void SpaceSlices::merge(const SpaceSlices& other) {
  for (size_t axis = 0; axis < 3; ++axis)
    for (size_t i = 0; i < SpaceGrid::kSlices; ++i) {
      Slice& slice = slices_[axis][i];
      slice.box.extend(other.slices_[axis][i].box);
      slice.entries += other.slices_[axis][i].entries;
      slice.exits += other.slices_[axis][i].exits;
    }
}

void SpaceSlices::sweep(const NodeContext& node, const AxisChoice& axis, const SpaceGrid& grid, uint32_t room) {
  const auto& slices = slices_[static_cast<size_t>(axis.axis)];
  std::array<PackedBox, SpaceGrid::kSlices> above;  // of this slice and all after it
  std::array<uint32_t, SpaceGrid::kSlices> exits{};
  for (size_t i = SpaceGrid::kSlices; i-- > 0;) {
    above[i] = slices[i].box;
    exits[i] = slices[i].exits;
    if (i + 1 == SpaceGrid::kSlices) continue;
    above[i].extend(above[i + 1]);
    exits[i] += exits[i + 1];
  }
  PackedBox below;
  uint32_t entries = 0;
  for (size_t i = 0; i < SpaceGrid::kPlanes; ++i) {
    below.extend(slices[i].box);
    entries += slices[i].entries;
    const uint32_t left = entries, right = exits[i + 1];
    if (left == 0 || right == 0 || left >= node.count || right >= node.count || left + right > room) continue;
    const Bounds left_box = below.unpacked(), right_box = above[i + 1].unpacked();
    if (is_empty(left_box) || is_empty(right_box)) continue;
    candidates_.push_back({axis, grid.plane(axis.axis, i), left, right});
    sides_.push_back(left_box);
    sides_.push_back(right_box);
  }
}

Cut SpaceSlices::best_cut(const ActiveStrategy& strategy, const NodeContext& node, const AxisOrder& order,
                          const SpaceGrid& grid, uint32_t room) {
  candidates_.clear();
  sides_.clear();
  for (size_t i = 0; i < static_cast<size_t>(order.count); ++i)
    if (grid.has(order.choices[i].axis)) sweep(node, order.choices[i], grid, room);
  Cut best;
  measures_.resize(sides_.size());
  strategy.measure(sides_, measures_, node);
  for (size_t i = 0; i < candidates_.size(); ++i) {
    const Candidate& c = candidates_[i];
    const float left = measures_[2 * i], right = measures_[2 * i + 1];
    const double cost = static_cast<double>(left) * c.left_count + static_cast<double>(right) * c.right_count;
    if (!(cost < best.cost)) continue;
    best = {Cut::Kind::kSpace, c.axis.axis,  c.axis.quality, 0,    0,     0,   c.plane, sides_[2 * i],
            sides_[2 * i + 1], c.left_count, c.right_count,  left, right, cost};
  }
  return best;
}

void part_by_plane(const Cut& cut, std::span<const Reference> references, const ActiveStrategy& strategy,
                   const NodeContext& node, const ClipPrimitive& clip, std::vector<Reference>& left,
                   std::vector<Reference>& right) {
  const double left_measure = static_cast<double>(cut.left_measure),
               right_measure = static_cast<double>(cut.right_measure);
  for (const Reference& reference : references) {
    if (reference.box.lo(cut.axis) >= cut.plane) {
      right.push_back(reference);
    } else if (reference.box.hi(cut.axis) <= cut.plane) {
      left.push_back(reference);
    } else {
      const Bounds whole = reference.box.unpacked();
      const std::array<Bounds, 2> grown{united(cut.left, whole), united(cut.right, whole)};
      std::array<float, 2> measures{};
      strategy.measure(grown, measures, node);
      const double all_left = static_cast<double>(measures[0]) * cut.left_count + right_measure * (cut.right_count - 1);
      const double all_right = left_measure * (cut.left_count - 1) + static_cast<double>(measures[1]) * cut.right_count;
      if (all_left <= cut.cost && all_left <= all_right) {
        left.push_back(reference);
      } else if (all_right <= cut.cost) {
        right.push_back(reference);
      } else {
        const Bounds lower = part_between(reference, cut.axis, -kInf, cut.plane, clip);
        const Bounds upper = part_between(reference, cut.axis, cut.plane, kInf, clip);
        if (is_empty(lower) && is_empty(upper)) {
          left.push_back(reference);  // a callback that denies the primitive: keep it whole
          continue;
        }
        if (!is_empty(lower)) left.push_back(with_box(reference, lower));
        if (!is_empty(upper)) right.push_back(with_box(reference, upper));
      }
    }
  }
}

}  // namespace raygrain::builder
