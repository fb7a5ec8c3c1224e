// One node of the parallel builder: leaf, or the best of all cuts, and its references parted.
#include <algorithm>
#include <utility>

#include "build/reference_scratch.h"
#include "build/top_down.h"

namespace raygrain::builder {

namespace {

/// Copies references to their sides. The boxes of both sides' keys.
template <class Reference>
std::array<KeyBox, 2> part(const Cut& cut, std::span<const Reference> references, Reference* target, size_t left,
                           size_t right) {
  const int axis = cut.axis;
  const float lo = cut.lo, scale = cut.scale, limit = cut.limit;
  constexpr std::array<float, 2> kAway{0, kInf};
  KeyBox left_keys, right_keys;
  for (const Reference& reference : references) {
    const size_t is_right = (reference.key(axis) - lo) * scale < limit ? 0 : 1;
    target[left + ((right - left) & (size_t{0} - is_right))] = reference;
    left += 1 - is_right;
    right += is_right;
    left_keys.extend(reference, kAway[is_right]);
    right_keys.extend(reference, kAway[1 - is_right]);
  }
  return {left_keys, right_keys};
}

uint32_t slices_for(uint32_t count, uint32_t most) {
  return std::min(most, 4 + count / 16);
}

}  // namespace

/// False for a leaf.
template <class Reference>
bool ReferenceBuilder<Reference>::split(const OpenRange& node, Scratch& scratch, unsigned threads, Children& children,
                                        NodeLog& note, Laps& laps) const {
  const NodeContext& context = node.context;
  const bool is_leaf =
      context.count < 2 || is_rare(node) || context.level >= kMaxTreeLevels || strategy_.stops(context, node.measure);
  laps.lap(&BuildTimes::stop);
  if (is_leaf) return false;
  const AxisOrder order = admitted_axes(context);
  note.orientations = static_cast<uint8_t>(order.count);
  laps.lap(&BuildTimes::orientations);
  scratch.prepare(context.count);
  Cut cut = find_cut(node, order, scratch, threads);
  Cut space = spatial_ ? find_space_cut(node, order, cut, scratch, threads) : Cut{};
  if (space && !part_by_space(node, space, cut.cost, scratch, threads, children)) space = {};
  if (!cut && !space && options_.split_inseparable) cut = find_last_cut(node, scratch, threads);
  const Cut& chosen = space ? space : cut;
  laps.lap(&BuildTimes::candidates);
  if (!chosen ||
      (options_.merge_leaves && is_leaf_cheaper(options_, context.count, node.measure,
                                                static_cast<double>(node.measure) * context.count, chosen.cost)))
    return false;
  if (!space) part_by_keys(node, chosen, scratch, threads, children);
  note.axis = static_cast<int8_t>(chosen.axis);
  note.quality = chosen.quality;
  note.ratio =
      node.measure > 0
          ? static_cast<float>((static_cast<double>(chosen.left_measure) + static_cast<double>(chosen.right_measure)) /
                               static_cast<double>(node.measure))
          : kInf;
  laps.lap(&BuildTimes::partition);
  return true;
}

/// So few primitives, met by so few rays, that no split can gain much.
template <class Reference>
bool ReferenceBuilder<Reference>::is_rare(const OpenRange& node) const {
  return node.context.count <= options_.rare_leaf_size &&
         static_cast<double>(node.measure) * static_cast<double>(input_.bounds.size()) <
             static_cast<double>(options_.rare_share) * static_cast<double>(root_measure_);
}

template <class Reference>
AxisOrder ReferenceBuilder<Reference>::admitted_axes(const NodeContext& node) const {
  const AxisOrder order = strategy_.axes(node);
  AxisOrder admitted;
  for (size_t i = 0; i < static_cast<size_t>(order.count); ++i)
    if (i == 0 || order.choices[i].quality >= options_.parameters.split_plane_quality_threshold)
      admitted.push(order.choices[i]);
  return admitted;
}

/// The best plane between keys.
template <class Reference>
Cut ReferenceBuilder<Reference>::find_cut(const OpenRange& node, const AxisOrder& order, Scratch& scratch,
                                          unsigned threads) const {
  if (node.context.count <= kSmallNode)
    return best_cut_of_small(references_of(node), strategy_, node.context, order, scratch.candidates);
  const SliceGrid grid(node.keys, slices_for(node.context.count, options_.parameters.bins));
  for_chunks(references_of(node), threads, [&](size_t chunk, std::span<const Reference> references) {
    scratch.slices[chunk].clear(grid.slices);
    if (order.count == 1)
      scratch.slices[chunk].add_along(order.choices[0].axis, grid, references);
    else
      scratch.slices[chunk].add(grid, references);
  });
  const size_t chunks = chunks_of(node.context);
  if (chunks == 1) return scratch.slices[0].best_cut(strategy_, node.context, order, grid, scratch.candidates);
  scratch.all_slices = scratch.slices[0];
  for (size_t i = 1; i < chunks; ++i) scratch.all_slices.merge(scratch.slices[i]);
  return scratch.all_slices.best_cut(strategy_, node.context, order, grid, scratch.candidates);
}

/// For keys that no plane of the admitted axes separates: the longest axis of their box, or else two halves of the list
/// where it is too long for a leaf.
template <class Reference>
Cut ReferenceBuilder<Reference>::find_last_cut(const OpenRange& node, Scratch& scratch, unsigned threads) const {
  AxisOrder order;
  order.push({longest_axis(node.keys.unpacked()), 0});
  if (const Cut cut = find_cut(node, order, scratch, threads)) return cut;
  const bool is_large = node.context.count > std::max(options_.leaf_size, options_.parameters.max_triangles_per_leaf);
  return is_large ? halve(node) : Cut{};
}

template <class Reference>
Cut ReferenceBuilder<Reference>::halve(const OpenRange& node) const {
  Cut cut;
  cut.kind = Cut::Kind::kHalves;
  cut.axis = longest_axis(node.context.bounds);
  cut.left_count = node.context.count / 2;
  cut.right_count = node.context.count - cut.left_count;
  const std::span<const Reference> references = references_of(node);
  PackedBox left, right;
  for (const Reference& reference : references.first(cut.left_count)) left.extend(reference.box);
  for (const Reference& reference : references.subspan(cut.left_count)) right.extend(reference.box);
  cut.left = left.unpacked();
  cut.right = right.unpacked();
  cut.left_measure = strategy_.measure(cut.left, node.context);
  cut.right_measure = strategy_.measure(cut.right, node.context);
  cut.cost =
      static_cast<double>(cut.left_measure) * cut.left_count + static_cast<double>(cut.right_measure) * cut.right_count;
  return cut;
}

template <class Reference>
void ReferenceBuilder<Reference>::open_children(const OpenRange& node, const Cut& cut, Children& children) const {
  const NodeContext& parent = node.context;
  children.left.context = child_context(parent, cut.left, cut.left_count, cut.axis, 1);
  children.right.context = child_context(parent, cut.right, cut.right_count, cut.axis, 2);
  children.left.measure = cut.left_measure;
  children.right.measure = cut.right_measure;
  // Room for references that later splits add, in proportion to counts.
  const size_t used = size_t{cut.left_count} + cut.right_count, spare = node.room - used;
  children.left.room = cut.left_count + (spare > 0 ? spare * cut.left_count / used : 0);
  children.right.room = node.room - children.left.room;
  children.left.begin = node.begin;
  children.right.begin = node.begin + children.left.room;
  children.left.in_second = children.right.in_second = !node.in_second;
}

/// Both sides keep their order.
template <class Reference>
void ReferenceBuilder<Reference>::part_by_keys(const OpenRange& node, const Cut& cut, Scratch& scratch,
                                               unsigned threads, Children& children) const {
  open_children(node, cut, children);
  const std::span<const Reference> all = references_of(node);
  Reference* const target = buffer(!node.in_second).data();
  if (cut.kind == Cut::Kind::kHalves) {
    // Smaller nodes have fewer slices: those may tell keys apart, and then want the exact box of them.
    for (const Reference& reference : all.first(cut.left_count)) children.left.keys.extend(reference);
    for (const Reference& reference : all.subspan(cut.left_count)) children.right.keys.extend(reference);
    std::copy_n(all.begin(), cut.left_count, target + children.left.begin);
    std::copy(all.begin() + cut.left_count, all.end(), target + children.right.begin);
    return;
  }
  const size_t chunks = chunks_of(node.context);
  if (chunks > 1)  // the cut is the last that slices were counted for
    for (size_t i = 0; i < chunks; ++i)
      scratch.left_counts[i] = scratch.slices[i].count_below(cut.axis, static_cast<uint32_t>(cut.limit));
  size_t lefts = 0;
  for (size_t i = 0; i < chunks; ++i) lefts += std::exchange(scratch.left_counts[i], lefts);
  for_chunks(all, threads, [&](size_t chunk, std::span<const Reference> references) {
    const size_t left_count = scratch.left_counts[chunk];
    scratch.keys[chunk] = part(cut, references, target, children.left.begin + left_count,
                               children.right.begin + (chunk * kChunk - left_count));
  });
  for (size_t i = 0; i < chunks; ++i) {
    children.left.keys.extend(scratch.keys[i][0]);
    children.right.keys.extend(scratch.keys[i][1]);
  }
}

template void ReferenceBuilder<Reference>::open_children(const OpenRange&, const Cut&, Children&) const;
template void ReferenceBuilder<KeyedReference>::open_children(const OpenRange&, const Cut&, Children&) const;
template bool ReferenceBuilder<Reference>::split(const OpenRange&, Scratch&, unsigned, Children&, NodeLog&,
                                                 Laps&) const;
template bool ReferenceBuilder<KeyedReference>::split(const OpenRange&, Scratch&, unsigned, Children&, NodeLog&,
                                                      Laps&) const;

}  // namespace raygrain::builder
