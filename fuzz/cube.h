// A mesh that everyone knows, and rays at its corners, edges and faces.
#pragma once

#include <vector>

#include "raygrain/mesh.h"
#include "raygrain/ray.h"

namespace raygrain::fuzz {

/// Twelve triangles.
TriangleMesh cube();

/// From a few origins to all corners, middles of edges and centroids; and some along the axes.
std::vector<Ray> rays_around(const TriangleMesh& mesh);

}  // namespace raygrain::fuzz
