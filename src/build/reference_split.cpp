// One node of the parallel builder: leaf, or the best of all cuts, and its references parted.
#include <algorithm>
#include <utility>

#include "base/parallel.h"
#include "build/reference_scratch.h"
#include "build/top_down.h"

namespace raygrain::builder {

namespace {

/// Calls body(chunk, references) for the chunks of a node; at once where there is only one.
template <class References, class Body>
void for_chunks(References references, unsigned threads, const Body& body) {
  if (references.size() <= kChunk) return body(size_t{0}, references);
  parallel_for(references.size(), kChunk, threads,
               [&](size_t begin, size_t end) { body(begin / kChunk, references.subspan(begin, end - begin)); });
}

size_t chunks_of(const NodeContext& node) {
  return (node.count + kChunk - 1) / kChunk;
}

/// A plane is tried on primitives where cutting boxes alone prices it below this many times the best other cut.
constexpr double kHope = 1.1;

uint32_t slices_for(uint32_t count, uint32_t most) {
  return std::min(most, 4 + count / 16);
}

}  // namespace

/// False for a leaf.
bool ReferenceBuilder::split(const OpenRange& node, Scratch& scratch, unsigned threads, Children& children,
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
bool ReferenceBuilder::is_rare(const OpenRange& node) const {
  return node.context.count <= options_.rare_leaf_size &&
         static_cast<double>(node.measure) * static_cast<double>(input_.bounds.size()) <
             static_cast<double>(options_.rare_share) * static_cast<double>(root_measure_);
}

AxisOrder ReferenceBuilder::admitted_axes(const NodeContext& node) const {
  const AxisOrder order = strategy_.axes(node);
  AxisOrder admitted;
  for (size_t i = 0; i < static_cast<size_t>(order.count); ++i)
    if (i == 0 || order.choices[i].quality >= options_.parameters.split_plane_quality_threshold)
      admitted.push(order.choices[i]);
  return admitted;
}

/// The best plane between keys.
Cut ReferenceBuilder::find_cut(const OpenRange& node, const AxisOrder& order, Scratch& scratch,
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

/// A plane that cuts primitives and costs less than `best`, where that leaves sides that overlap.
Cut ReferenceBuilder::find_space_cut(const OpenRange& node, const AxisOrder& order, const Cut& best, Scratch& scratch,
                                     unsigned threads) const {
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

/// For keys that no plane of the admitted axes separates: the longest axis of their box, or else two halves of the list
/// where it is too long for a leaf.
Cut ReferenceBuilder::find_last_cut(const OpenRange& node, Scratch& scratch, unsigned threads) const {
  AxisOrder order;
  order.push({longest_axis(node.keys.unpacked()), 0});
  if (const Cut cut = find_cut(node, order, scratch, threads)) return cut;
  const bool is_large = node.context.count > std::max(options_.leaf_size, options_.parameters.max_triangles_per_leaf);
  return is_large ? halve(node) : Cut{};
}

Cut ReferenceBuilder::halve(const OpenRange& node) const {
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

ReferenceBuilder::Children ReferenceBuilder::open_children(const OpenRange& node, const Cut& cut) const {
  const NodeContext& parent = node.context;
  Children children;
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
  return children;
}

/// Cuts primitives at the plane and makes `cut` say what came of it. False where that costs no less than `limit`, or
/// takes more room than there is, or gains nothing.
bool ReferenceBuilder::part_by_space(const OpenRange& node, Cut& cut, double limit, Scratch& scratch, unsigned threads,
                                     Children& children) const {
  const size_t chunks = chunks_of(node.context);
  for_chunks(references_of(node), threads, [&](size_t chunk, std::span<const Reference> references) {
    scratch.sides[chunk].part(cut, references, options_.clip);
  });
  if (!price_sides(node, cut, {scratch.sides.data(), chunks}) || !(cut.cost < limit)) return false;
  for_chunks(references_of(node), threads, [&](size_t chunk, std::span<const Reference>) {
    scratch.sides[chunk].mend(cut, strategy_, node.context);
  });
  std::array<PackedBox, 2> boxes, keys;
  cut.left_count = cut.right_count = 0;
  for (size_t i = 0; i < chunks; ++i) {
    const SpaceSides& sides = scratch.sides[i];
    cut.left_count += static_cast<uint32_t>(sides.left.size());
    cut.right_count += static_cast<uint32_t>(sides.right.size());
    const auto extend = [&](size_t side, const Reference& reference) {
      boxes[side].extend(reference.box);
      keys[side].extend(reference.key_box());
    };
    for (const Reference& reference : sides.left) extend(0, reference);
    for (const Reference& reference : sides.right) extend(1, reference);
  }
  if (!fits(node, cut)) return false;
  cut.left = boxes[0].unpacked();
  cut.right = boxes[1].unpacked();
  cut.left_measure = strategy_.measure(cut.left, node.context);
  cut.right_measure = strategy_.measure(cut.right, node.context);
  children = open_children(node, cut);
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
bool ReferenceBuilder::price_sides(const OpenRange& node, Cut& cut, std::span<const SpaceSides> chunks) const {
  PackedBox left, right;
  cut.left_count = cut.right_count = 0;
  for (const SpaceSides& sides : chunks) {
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

bool ReferenceBuilder::fits(const OpenRange& node, const Cut& cut) {
  return cut.left_count > 0 && cut.right_count > 0 && std::max(cut.left_count, cut.right_count) < node.context.count &&
         size_t{cut.left_count} + cut.right_count <= node.room;
}

/// Both sides keep their order.
void ReferenceBuilder::part_by_keys(const OpenRange& node, const Cut& cut, Scratch& scratch, unsigned threads,
                                    Children& children) const {
  children = open_children(node, cut);
  const std::span<const Reference> all = references_of(node);
  Reference* const target = buffer(!node.in_second).data();
  if (cut.kind == Cut::Kind::kHalves) {
    std::copy_n(all.begin(), cut.left_count, target + children.left.begin);
    std::copy(all.begin() + cut.left_count, all.end(), target + children.right.begin);
    children.left.keys = children.right.keys = node.keys;
    return;
  }
  const auto axis = static_cast<size_t>(cut.axis);
  const auto is_left = [&](const Reference& reference) {
    return (reference.key.at[axis] - cut.lo) * cut.scale < cut.limit;
  };
  const size_t chunks = chunks_of(node.context);
  if (chunks > 1)  // the cut is the last that slices were counted for
    for (size_t i = 0; i < chunks; ++i)
      scratch.left_counts[i] = scratch.slices[i].count_below(cut.axis, static_cast<uint32_t>(cut.limit));
  size_t lefts = 0;
  for (size_t i = 0; i < chunks; ++i) lefts += std::exchange(scratch.left_counts[i], lefts);
  for_chunks(all, threads, [&](size_t chunk, std::span<const Reference> references) {
    std::array<size_t, 2> at{children.left.begin + scratch.left_counts[chunk],
                             children.right.begin + chunk * kChunk - scratch.left_counts[chunk]};
    std::array<PackedBox, 2> keys;
    for (const Reference& reference : references) {
      const size_t side = is_left(reference) ? 0 : 1;
      target[at[side]++] = reference;
      keys[side].extend(reference.key_box());
    }
    scratch.keys[chunk] = keys;
  });
  for (size_t i = 0; i < chunks; ++i) {
    children.left.keys.extend(scratch.keys[i][0]);
    children.right.keys.extend(scratch.keys[i][1]);
  }
}

}  // namespace raygrain::builder
