// What one thread needs while it splits nodes; kept from node to node, so that no node allocates.
#pragma once

#include "build/reference_builder.h"

namespace raygrain::builder {

inline constexpr size_t kChunk = 16384;  // references that one thread takes at a time

struct ReferenceBuilder::Scratch {
  CutCandidates candidates;
  std::vector<Slices> slices;  // by chunk
  Slices all_slices;           // of all chunks, where there are several
  std::vector<SpaceSlices> space;
  std::vector<SpaceSides> sides;
  std::vector<std::array<PackedBox, 2>> keys;  // of left and right side
  std::vector<size_t> left_counts;

  void prepare(size_t count) {
    const size_t chunks = (count + kChunk - 1) / kChunk;
    if (slices.size() < chunks) slices.resize(chunks);
    if (sides.size() < chunks) sides.resize(chunks);
    if (keys.size() < chunks) keys.resize(chunks);
    if (left_counts.size() < chunks) left_counts.resize(chunks);
  }
};

}  // namespace raygrain::builder
