// Planes through space of the parallel builder: the one that costs less than any plane between keys, and references cut
// at it.
#include <algorithm>

#include "build/reference_scratch.h"

namespace raygrain::builder {

namespace {

/// A plane is tried on primitives where cutting boxes alone prices it below this many times the best other cut.
constexpr double kHope = 1.1;

}  // namespace

/// A plane that cuts primitives and costs less than `best`, where that leaves sides that overlap.
template <class Reference>
Cut ReferenceBuilder<Reference>::find_space_cut(const OpenRange& node, const AxisOrder& order, const Cut& best,
                                                Scratch& scratch, unsigned threads) const {
  if (node.room <= node.context.count) return {};
  if (best) {
    const Bounds overlap = intersected(best.left, best.right);
    if (is_empty(overlap)) return {};
    if (!(strategy_.measure(overlap, node.context) > options_.spatial.overlap * root_measure_)) return {};
  }
  const SpaceGrid grid(node.context.bounds);
  if (scratch.space.size() < chunks_of(node.context)) scratch.space.resize(chunks_of(node.context));
  for_chunks(references_of(node), threads, [&](size_t chunk, std::span<const Reference> references) {
    scratch.space[chunk].clear();
    scratch.space[chunk].add(grid, references);
  });
  for (size_t i = 1; i < chunks_of(node.context); ++i) scratch.space[0].merge(scratch.space[i]);
  const Cut cut = scratch.space[0].best_cut(strategy_, node.context, order, grid);
  return cut && cut.cost < kHope * best.cost ? cut : Cut{};
}

/// Cuts primitives at the plane and makes `cut` say what came of it. False where that costs no less than `limit`, or
/// takes more room than there is, or gains nothing.
template <class Reference>
bool ReferenceBuilder<Reference>::part_by_space(const OpenRange& node, Cut& cut, double limit, Scratch& scratch,
                                                unsigned threads, Children& children) const {
  const size_t chunks = chunks_of(node.context);
  for_chunks(references_of(node), threads, [&](size_t chunk, std::span<const Reference> references) {
    scratch.sides[chunk].part(cut, references, options_.clip);
  });
  if (!price_sides(node, cut, {scratch.sides.data(), chunks}) || !(cut.cost < limit)) return false;
  for_chunks(references_of(node), threads, [&](size_t chunk, std::span<const Reference>) {
    scratch.sides[chunk].mend(cut, strategy_, node.context);
  });
  std::array<PackedBox, 2> boxes;
  std::array<KeyBox, 2> keys;
  cut.left_count = cut.right_count = 0;
  for (size_t i = 0; i < chunks; ++i) {
    const SpaceSides<Reference>& sides = scratch.sides[i];
    cut.left_count += static_cast<uint32_t>(sides.left.size());
    cut.right_count += static_cast<uint32_t>(sides.right.size());
    const auto extend = [&](size_t side, const Reference& reference) {
      boxes[side].extend(reference.box);
      keys[side].extend(reference);
    };
    for (const Reference& reference : sides.left) extend(0, reference);
    for (const Reference& reference : sides.right) extend(1, reference);
  }
  if (!fits(node, cut)) return false;
  cut.left = boxes[0].unpacked();
  cut.right = boxes[1].unpacked();
  cut.left_measure = strategy_.measure(cut.left, node.context);
  cut.right_measure = strategy_.measure(cut.right, node.context);
  open_children(node, cut, children);
  children.left.keys = keys[0];
  children.right.keys = keys[1];
  auto left = buffer(!node.in_second).begin() + static_cast<std::ptrdiff_t>(children.left.begin);
  auto right = buffer(!node.in_second).begin() + static_cast<std::ptrdiff_t>(children.right.begin);
  for (size_t i = 0; i < chunks; ++i) {
    left = std::copy(scratch.sides[i].left.begin(), scratch.sides[i].left.end(), left);
    right = std::copy(scratch.sides[i].right.begin(), scratch.sides[i].right.end(), right);
  }
  return true;
}

/// The sides with all parts.
template <class Reference>
bool ReferenceBuilder<Reference>::price_sides(const OpenRange& node, Cut& cut,
                                              std::span<const SpaceSides<Reference>> chunks) const {
  PackedBox left, right;
  cut.left_count = cut.right_count = 0;
  for (const SpaceSides<Reference>& sides : chunks) {
    left.extend(sides.left_box);
    right.extend(sides.right_box);
    cut.left_count += static_cast<uint32_t>(sides.left.size() + sides.torn.size());
    cut.right_count += static_cast<uint32_t>(sides.right.size() + sides.torn.size());
  }
  if (!fits(node, cut)) return false;
  cut.left = left.unpacked();
  cut.right = right.unpacked();
  std::array<float, 2> measures{};
  strategy_.measure(std::array{cut.left, cut.right}, measures, node.context);
  cut.left_measure = measures[0];
  cut.right_measure = measures[1];
  cut.cost =
      static_cast<double>(cut.left_measure) * cut.left_count + static_cast<double>(cut.right_measure) * cut.right_count;
  return true;
}

template <class Reference>
bool ReferenceBuilder<Reference>::fits(const OpenRange& node, const Cut& cut) {
  return cut.left_count > 0 && cut.right_count > 0 && std::max(cut.left_count, cut.right_count) < node.context.count &&
         size_t{cut.left_count} + cut.right_count <= node.room;
}

template Cut ReferenceBuilder<Reference>::find_space_cut(const OpenRange&, const AxisOrder&, const Cut&, Scratch&,
                                                         unsigned) const;
template Cut ReferenceBuilder<KeyedReference>::find_space_cut(const OpenRange&, const AxisOrder&, const Cut&, Scratch&,
                                                              unsigned) const;
template bool ReferenceBuilder<Reference>::part_by_space(const OpenRange&, Cut&, double, Scratch&, unsigned,
                                                         Children&) const;
template bool ReferenceBuilder<KeyedReference>::part_by_space(const OpenRange&, Cut&, double, Scratch&, unsigned,
                                                              Children&) const;

}  // namespace raygrain::builder
