// The searches of a wide tree in ray space, once per instruction set.
#pragma once

#include "trace/frame_memory.h"

namespace raygrain {

/// One instruction set's searches. Queries are prepared for the tree, which is not empty; their column.box is not
/// empty.
struct FrameKernels {
  Hit (*nearest)(const FrameMemory& tree, const FrameQuery& query, FrameUse use, const Ray& ray, const Hit& known);
  bool (*any)(const FrameMemory& tree, const FrameQuery& query, FrameUse use, const Ray& ray);
  Hit (*nearest_counted)(const FrameMemory& tree, const FrameQuery& query, FrameUse use, const Ray& ray,
                         const Hit& known, bool prune, TraceCounters& counters);
  bool (*any_counted)(const FrameMemory& tree, const FrameQuery& query, FrameUse use, const Ray& ray, bool prune,
                      TraceCounters& counters);
};

/// Null for instruction sets that this CPU or this build lacks.
const FrameKernels* frame_kernels(Isa isa);

}  // namespace raygrain
