#include "raygrain/trace.h"

namespace raygrain {

void TraceCounters::add(const TraceCounters& other) {
  inner_hits += other.inner_hits;
  leaf_hits += other.leaf_hits;
  leaf_triangles += other.leaf_triangles;
  box_tests += other.box_tests;
  triangle_tests += other.triangle_tests;
}

}  // namespace raygrain
