#include "build/space_slices.h"

#include <cmath>

namespace raygrain::builder {

namespace {

/// The part of a reference's primitive between two planes: within the reference's box, whatever the callback says.
template <class Reference>
Bounds part_between(const Reference& reference, int axis, float lo, float hi, const ClipPrimitive& clip) {
  Bounds box = reference.box.unpacked();
  box.lo[axis] = std::max(box.lo[axis], lo);
  box.hi[axis] = std::min(box.hi[axis], hi);
  return intersected(box, clip(reference.id(), box));
}

}  // namespace

SpaceGrid::SpaceGrid(const Bounds& box) {
  const Vec3 length = extent(box);
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<size_t>(axis);
    lo[i] = box.lo[axis];
    step[i] = length[axis] * (1.0f / kSlices);
    const float candidate = kSlices / length[axis];
    scale[i] = candidate > 0 && candidate <= std::numeric_limits<float>::max() ? candidate : 0;  // a length may be -0
  }
}

void SpaceSlices::clear() {
  for (auto& axis : slices_) axis.fill(Slice{});
}

template <class Reference>
void SpaceSlices::add(const SpaceGrid& grid, std::span<const Reference> references) {
  constexpr float kTop = SpaceGrid::kSlices - 1, kLess = 1 - 0x1p-20f;  // an end on a plane lies below it
  for (const Reference& reference : references) {
    for (size_t axis = 0; axis < 3; ++axis) {
      auto& slices = slices_[axis];
      const float lower = (reference.box.lanes.at[axis] - grid.lo[axis]) * grid.scale[axis];
      const float upper = (-reference.box.lanes.at[axis + 4] - grid.lo[axis]) * grid.scale[axis] * kLess;
      const auto first = static_cast<uint32_t>(static_cast<int32_t>(lower < kTop ? lower : kTop));
      const auto last = static_cast<uint32_t>(static_cast<int32_t>(upper < kTop ? upper : kTop));
      const uint32_t end = std::max(first, last);
      slices[first].lo = std::min(slices[first].lo, reference.box.lanes.at[axis]);
      ++slices[first].entries;
      slices[end].hi = std::max(slices[end].hi, -reference.box.lanes.at[axis + 4]);
      ++slices[end].exits;
      for (uint32_t slice = first; slice <= end; ++slice) slices[slice].box.extend(reference.box);
    }
  }
}

void SpaceSlices::merge(const SpaceSlices& other) {
  for (size_t axis = 0; axis < 3; ++axis)
    for (size_t i = 0; i < SpaceGrid::kSlices; ++i) {
      Slice& slice = slices_[axis][i];
      slice.box.extend(other.slices_[axis][i].box);
      slice.lo = std::min(slice.lo, other.slices_[axis][i].lo);
      slice.hi = std::max(slice.hi, other.slices_[axis][i].hi);
      slice.entries += other.slices_[axis][i].entries;
      slice.exits += other.slices_[axis][i].exits;
    }
}

/// What references leave in each slice: those that cross a plane reach up to it on both of its sides.
std::array<PackedBox, SpaceGrid::kSlices> SpaceSlices::boxes_of(const AxisSlices& slices, int axis,
                                                                const SpaceGrid& grid) {
  std::array<PackedBox, SpaceGrid::kSlices> boxes;
  uint32_t crossing = 0;
  float lo = kInf;  // of those that cross the plane below
  for (uint32_t i = 0; i < SpaceGrid::kSlices; ++i) {
    crossing += slices[i].entries - slices[i].exits;
    const float plane = grid.plane(static_cast<size_t>(axis), i + 1);
    boxes[i] = slices[i].box;
    boxes[i].set_lo(axis, std::min(slices[i].lo, lo));
    boxes[i].set_hi(axis, std::max(slices[i].hi, crossing > 0 ? plane : -kInf));
    lo = crossing > 0 ? plane : kInf;
  }
  return boxes;
}

void SpaceSlices::sweep(const NodeContext& node, const AxisChoice& axis, const SpaceGrid& grid) {
  const auto& slices = slices_[static_cast<size_t>(axis.axis)];
  const std::array<PackedBox, SpaceGrid::kSlices> boxes = boxes_of(slices, axis.axis, grid);
  std::array<PackedBox, SpaceGrid::kSlices> above;  // of this slice and all after it
  std::array<uint32_t, SpaceGrid::kSlices> exits{};
  for (size_t i = SpaceGrid::kSlices; i-- > 0;) {
    above[i] = boxes[i];
    exits[i] = slices[i].exits;
    if (i + 1 == SpaceGrid::kSlices) continue;
    above[i].extend(above[i + 1]);
    exits[i] += exits[i + 1];
  }
  PackedBox below;
  uint32_t entries = 0;
  for (uint32_t i = 0; i + 1 < SpaceGrid::kSlices; ++i) {
    below.extend(boxes[i]);
    entries += slices[i].entries;
    const uint32_t left = entries, right = exits[i + 1];
    if (left == 0 || right == 0 || left >= node.count || right >= node.count) continue;
    const Bounds left_box = below.unpacked(), right_box = above[i + 1].unpacked();
    if (is_empty(left_box) || is_empty(right_box)) continue;
    candidates_.push_back({axis, grid.plane(static_cast<size_t>(axis.axis), i + 1), left, right});
    sides_.push_back(left_box);
    sides_.push_back(right_box);
  }
}

Cut SpaceSlices::best_cut(const ActiveStrategy& strategy, const NodeContext& node, const AxisOrder& order,
                          const SpaceGrid& grid) {
  candidates_.clear();
  sides_.clear();
  for (size_t i = 0; i < static_cast<size_t>(order.count); ++i)
    if (grid.scale[static_cast<size_t>(order.choices[i].axis)] > 0) sweep(node, order.choices[i], grid);
  Cut best;
  if (candidates_.empty()) return best;
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

template <class Reference>
void SpaceSides<Reference>::part(const Cut& plane, std::span<const Reference> references, const ClipPrimitive& clip) {
  left.clear();
  right.clear();
  torn.clear();
  left_box = right_box = {};
  const auto put_left = [&](const Reference& reference) {
    left.push_back(reference);
    left_box.extend(reference.box);
  };
  const auto put_right = [&](const Reference& reference) {
    right.push_back(reference);
    right_box.extend(reference.box);
  };
  for (const Reference& reference : references) {
    if (reference.box.lo(plane.axis) >= plane.plane) {
      put_right(reference);
    } else if (reference.box.hi(plane.axis) <= plane.plane) {
      put_left(reference);
    } else {
      const Bounds lower = part_between(reference, plane.axis, -kInf, plane.plane, clip);
      const Bounds upper = part_between(reference, plane.axis, plane.plane, kInf, clip);
      if (is_empty(lower) && is_empty(upper)) {
        put_left(reference);  // a callback that denies the primitive: keep it whole
      } else if (is_empty(upper)) {
        put_left(reference.with_box(lower));
      } else if (is_empty(lower)) {
        put_right(reference.with_box(upper));
      } else {
        torn.push_back({reference, lower, upper});
        left_box.extend(PackedBox::of(lower));
        right_box.extend(PackedBox::of(upper));
      }
    }
  }
}

template <class Reference>
void SpaceSides<Reference>::mend(const Cut& cut, const ActiveStrategy& strategy, const NodeContext& node) {
  const auto left_measure = static_cast<double>(cut.left_measure);
  const auto right_measure = static_cast<double>(cut.right_measure);
  for (const Torn& reference : torn) {
    const Bounds whole = reference.whole.box.unpacked();
    const std::array<Bounds, 2> grown{united(cut.left, whole), united(cut.right, whole)};
    std::array<float, 2> measures{};
    strategy.measure(grown, measures, node);
    const double all_left = static_cast<double>(measures[0]) * cut.left_count + right_measure * (cut.right_count - 1);
    const double all_right = left_measure * (cut.left_count - 1) + static_cast<double>(measures[1]) * cut.right_count;
    if (all_left <= cut.cost && all_left <= all_right) {
      left.push_back(reference.whole);
    } else if (all_right <= cut.cost) {
      right.push_back(reference.whole);
    } else {
      left.push_back(reference.whole.with_box(reference.lower));
      right.push_back(reference.whole.with_box(reference.upper));
    }
  }
}

template void SpaceSlices::add(const SpaceGrid&, std::span<const Reference>);
template void SpaceSlices::add(const SpaceGrid&, std::span<const KeyedReference>);
template struct SpaceSides<Reference>;
template struct SpaceSides<KeyedReference>;

}  // namespace raygrain::builder
