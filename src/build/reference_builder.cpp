#include "build/reference_builder.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"
#include "base/timer.h"
#include "build/reference_scratch.h"
#include "build/top_down.h"

namespace raygrain::builder {

namespace {

/// Writes one reference, numbers one by one; its key. To write lanes and read them at once as a vector would be slow.
Vec3 put(const Input& input, size_t i, Reference& reference) {
  const Bounds& box = input.bounds[i];
  reference = Reference::of(box, static_cast<uint32_t>(i));
  return box.lo + box.hi;
}
Vec3 put(const Input& input, size_t i, KeyedReference& reference) {
  reference = KeyedReference::of(input.bounds[i], input.centroids[i], static_cast<uint32_t>(i));
  return input.centroids[i];
}

/// Whether references need no keys of their own: sums of two coordinates and the sums' distances stay in float's range,
/// and so do numbers with the bits of ids.
bool need_no_keys(const Input& input) {
  constexpr float kMost = std::numeric_limits<float>::max() / 4;
  return input.centroids.empty() && input.bounds.size() < std::bit_cast<uint32_t>(kInf) &&
         contains(Bounds{{-kMost, -kMost, -kMost}, {kMost, kMost, kMost}}, input.reach);
}

}  // namespace

template <class Reference>
ReferenceBuilder<Reference>::ReferenceBuilder(const Input& input, const BuildOptions& options, bool spatial)
    : input_(input),
      options_(options),
      spatial_(spatial),
      strategy_(options.strategy, options.parameters, options.costs),
      monitor_(options.progress, input.bounds.size()) {}

template <class Reference>
void ReferenceBuilder<Reference>::fill(std::span<Reference> references, Bounds& box, KeyBox& keys) const {
  const size_t count = input_.bounds.size();
  std::vector<std::array<Bounds, 2>> chunks((count + kChunk - 1) / kChunk);
  parallel_for(count, kChunk, options_.threads, [&](size_t begin, size_t end) {
    Bounds all, all_keys;
    for (size_t i = begin; i < end; ++i) {
      all.extend(input_.bounds[i]);
      all_keys.extend(put(input_, i, references[i]));
    }
    chunks[begin / kChunk] = {all, all_keys};
  });
  Bounds all_keys;
  for (const auto& [part, part_keys] : chunks) {
    box.extend(part);
    all_keys.extend(part_keys);
  }
  keys = KeyBox::of(all_keys);
}

template <class Reference>
Bvh ReferenceBuilder<Reference>::build(BuildLog* log) {
  Laps laps(log ? &log->times : nullptr);
  if (input_.bounds.empty()) return {};
  logging_ = log != nullptr;
  const size_t count = input_.bounds.size();
  const auto extra =
      static_cast<size_t>(spatial_ ? static_cast<double>(options_.spatial.budget) * static_cast<double>(count) : 0);
  const size_t room = std::min(count + extra, size_t{1} << 31);
  both_ = Buffer<Reference>(2 * room);
  Bounds box;
  OpenRange root;
  fill(buffer(false), box, root.keys);
  root.context = root_context(box, static_cast<uint32_t>(count), options_.seed);
  root.room = room;
  strategy_.set_total(root.context);
  root_measure_ = root.measure = strategy_.measure(root.context.bounds, root.context);
  laps.lap(&BuildTimes::nodes);

  split_top(root, log ? &log->times : nullptr);
  std::vector<Piece> pieces(subtrees_.size());
  const Timer timer;
  parallel_for(pieces.size(), 1, options_.threads, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) pieces[i] = build_piece(subtrees_[i]);
  });
  laps.skip();
  if (log) add_scaled<Piece>(log->times, pieces, timer.seconds());
  if (log) log->peak_bytes = both_.bytes();
  Bvh bvh = assemble(pieces, log);
  laps.lap(&BuildTimes::nodes);
  return bvh;
}

/// Depth first, left before right; children are allocated in pairs.
template <class Reference>
Piece ReferenceBuilder<Reference>::build_piece(const OpenRange& root) const {
  Piece piece;
  Laps laps(logging_ ? &piece.times : nullptr);
  piece.nodes.reserve(2 * std::min<size_t>(root.room, size_t{root.context.count} + root.context.count / 4));
  piece.prims.reserve(root.room);
  piece.nodes.resize(1);
  piece.notes.resize(1);
  std::vector<OpenRange> open{root};
  Scratch scratch;
  while (!open.empty()) {
    const OpenRange node = open.back();
    open.pop_back();
    Children children;
    NodeLog note;
    if (!split(node, scratch, 1, children, note, laps)) {
      piece.nodes[node.index] = {node.context.bounds, static_cast<uint32_t>(piece.prims.size()), node.context.count};
      if (logging_) piece.notes[node.index] = note;
      for (const Reference& reference : references_of(node)) piece.prims.push_back(reference.id());
      if (spatial_) std::sort(piece.prims.end() - node.context.count, piece.prims.end());
      continue;
    }
    const auto first = static_cast<uint32_t>(piece.nodes.size());
    piece.nodes[node.index] = {node.context.bounds, first, 0};
    piece.nodes.resize(piece.nodes.size() + 2);
    if (logging_) {
      piece.notes[node.index] = note;
      piece.notes.resize(piece.nodes.size());
    }
    children.left.index = first;
    children.right.index = first + 1;
    open.push_back(children.right);
    open.push_back(children.left);
    laps.lap(&BuildTimes::nodes);
  }
  laps.finish();
  monitor_.finish(root.context.count);
  return piece;
}

/// For all of the pieces, and of what lies above them.
template <class Reference>
Bvh ReferenceBuilder<Reference>::make_room(std::span<const Piece> pieces, BuildLog* log) const {
  size_t node_count = top_.size(), prim_count = 0;
  for (const Piece& piece : pieces) {
    node_count += piece.nodes.size() - 1;
    prim_count += piece.prims.size();
  }
  Bvh bvh;
  bvh.nodes.resize(node_count);
  bvh.prims.resize(prim_count);
  bvh.split_references = prim_count > input_.bounds.size();
  if (!log) return bvh;
  log->nodes.resize(node_count);
  log->peak_bytes += memory_bytes(bvh);
  for (const Piece& piece : pieces)
    log->peak_bytes += piece.nodes.capacity() * sizeof(Bvh::Node) + piece.prims.capacity() * sizeof(uint32_t);
  return bvh;
}

/// In the order in which one thread alone would have made the nodes. Writes those above the pieces.
template <class Reference>
std::vector<PiecePlace> ReferenceBuilder<Reference>::place_pieces(std::span<const Piece> pieces, Bvh& bvh,
                                                                  BuildLog* log) const {
  std::vector<PiecePlace> places(pieces.size());
  struct Visit {
    uint32_t top, place;
  };
  std::vector<Visit> open{{0, 0}};
  uint32_t next_node = 1, next_prim = 0;
  while (!open.empty()) {
    const auto [top, place] = open.back();
    open.pop_back();
    const TopNode& node = top_[top];
    if (node.piece >= 0) {
      const Piece& piece = pieces[static_cast<size_t>(node.piece)];
      places[static_cast<size_t>(node.piece)] = {place, next_node, next_prim};
      next_node += static_cast<uint32_t>(piece.nodes.size() - 1);
      next_prim += static_cast<uint32_t>(piece.prims.size());
      continue;
    }
    bvh.nodes[place] = {node.node.bounds, next_node, 0};
    if (log) log->nodes[place] = node.note;
    open.push_back({node.node.first + 1, next_node + 1});
    open.push_back({node.node.first, next_node});
    next_node += 2;
  }
  return places;
}

template <class Reference>
Bvh ReferenceBuilder<Reference>::assemble(std::vector<Piece>& pieces, BuildLog* log) const {
  Bvh bvh = make_room(pieces, log);
  const std::vector<PiecePlace> places = place_pieces(pieces, bvh, log);
  parallel_for(pieces.size(), 1, options_.threads, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      Piece& piece = pieces[i];
      const PiecePlace& place = places[i];
      for (size_t k = 0; k < piece.nodes.size(); ++k) {
        const size_t at = k == 0 ? place.root : place.first_node + k - 1;
        Bvh::Node node = piece.nodes[k];
        node.first += node.is_leaf() ? place.first_prim : place.first_node - 1;
        bvh.nodes[at] = node;
        if (log) log->nodes[at] = piece.notes[k];
      }
      std::copy(piece.prims.begin(), piece.prims.end(), bvh.prims.begin() + place.first_prim);
      piece = {};
    }
  });
  return bvh;
}

bool has_references(const Input& input, const BuildStrategy& strategy) {
  if (strategy.cost || strategy.planes || strategy.partition || strategy.stop) return false;
  return input.bounds.empty() || is_finite(extent(input.reach));
}

Bvh build_from_references(const Input& input, const BuildOptions& options, bool spatial, BuildLog* log) {
  if (log) *log = {};
  const Timer timer;
  Bvh bvh;
  if (need_no_keys(input)) {
    bvh = ReferenceBuilder<Reference>(input, options, spatial).build(log);
  } else {
    Input keyed = input;
    std::vector<Vec3> centers;
    if (input.centroids.empty()) keyed.centroids = centers = box_centers(input.bounds, options.threads);
    bvh = ReferenceBuilder<KeyedReference>(keyed, options, spatial).build(log);
  }
  if (log) log->times.total = timer.seconds();
  return bvh;
}

}  // namespace raygrain::builder
