// The boxes of all triangles, made by several threads.
#pragma once

#include <vector>

#include "raygrain/mesh.h"

namespace raygrain {

/// One box per triangle, in triangle order; `threads` 0: all.
std::vector<Bounds> triangle_boxes(const TriangleMesh& mesh, unsigned threads);

}  // namespace raygrain
