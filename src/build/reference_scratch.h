// What one thread needs while it splits nodes; kept from node to node, so that few nodes allocate.
#pragma once

#include "base/parallel.h"
#include "build/reference_builder.h"

namespace raygrain::builder {

inline constexpr size_t kChunk = 4096;  // references that one thread takes at a time

template <class Reference>
struct ReferenceBuilder<Reference>::Scratch {
  CutCandidates candidates;
  std::vector<Slices> slices;  // by chunk
  Slices all_slices;           // of all chunks, where there are several
  std::vector<SpaceSlices> space;
  std::vector<SpaceSides<Reference>> sides;
  std::vector<std::array<KeyBox, 2>> keys;  // of left and right side
  std::vector<size_t> left_counts;

  void prepare(size_t count) {
    const size_t chunks = (count + kChunk - 1) / kChunk;
    if (slices.size() < chunks) slices.resize(chunks);
    if (sides.size() < chunks) sides.resize(chunks);
    if (keys.size() < chunks) keys.resize(chunks);
    if (left_counts.size() < chunks) left_counts.resize(chunks);
  }
};

/// Calls body(chunk, references) for the chunks of a node; at once where there is only one.
template <class References, class Body>
void for_chunks(References references, unsigned threads, const Body& body) {
  if (references.size() <= kChunk) return body(size_t{0}, references);
  parallel_for(references.size(), kChunk, threads,
               [&](size_t begin, size_t end) { body(begin / kChunk, references.subspan(begin, end - begin)); });
}

inline size_t chunks_of(const NodeContext& node) {
  return (node.count + kChunk - 1) / kChunk;
}

}  // namespace raygrain::builder
