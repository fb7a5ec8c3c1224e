// How a coverage of parallel rays looks at the world.
#pragma once

#include "trace/coverage_grid.h"

namespace raygrain {

/// Across the rays: the linear map of their plane in which edges cross as few lines of a square grid as may be. Along
/// them: the distance to a plane that lies as most of the mesh does. So the map turns with the scene. No row is longer
/// than one. `direction` is not zero. docs/theory-coverage.md, "Which map".
ColumnMap choose_parallel_map(const TriangleMesh& mesh, Vec3 direction, Vec3 center);

}  // namespace raygrain
