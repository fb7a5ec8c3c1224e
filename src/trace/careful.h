// Searches of a wide tree in double precision, for rays and scenes of any size. Right but not fast: the kernels hand
// over what floats cannot decide.
#pragma once

#include "raygrain/trace.h"

#include "trace/wide_tree.h"

namespace raygrain {

Hit nearest_carefully(const WideTree& tree, const Ray& ray, Hit known, const SearchOptions& options,
                      TraceCounters* counters);
bool any_carefully(const WideTree& tree, const Ray& ray, const SearchOptions& options, TraceCounters* counters);

}  // namespace raygrain
