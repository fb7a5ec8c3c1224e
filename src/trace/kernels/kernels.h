// The searches of a wide tree, once per instruction set. This folder is the only place with SIMD.
#pragma once

#include "raygrain/wide.h"

#include "trace/wide_tree.h"

namespace raygrain {

/// One instruction set's searches. Any rays; the tree is not empty.
struct Kernels {
  Hit (*nearest)(const WideTree& tree, const Ray& ray, Hit known, float skip_before);
  bool (*any)(const WideTree& tree, const Ray& ray, float skip_before);
  Hit (*nearest_counted)(const WideTree& tree, const Ray& ray, Hit known, const SearchOptions& options,
                         TraceCounters& counters);
  bool (*any_counted)(const WideTree& tree, const Ray& ray, const SearchOptions& options, TraceCounters& counters);
  void (*nearest_of_many)(const WideTree& tree, const Ray* rays, Hit* hits, size_t count);
  void (*any_of_many)(const WideTree& tree, const Ray* rays, uint8_t* flags, size_t count);
};

/// Null for instruction sets that this CPU or this build lacks.
const Kernels* kernels(Isa isa);

}  // namespace raygrain
