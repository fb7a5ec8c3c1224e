// Trees in ray space as rows of a grid.
#pragma once

#include "raygrain/ray_frame.h"

#include "study/tree_row.h"

namespace raygrain::study {

/// Builds the tree in each frame that suits the area, keeps the one of least predicted cost, and sets the columns that
/// such a tree has: not those that price it by boxes of the world.
void set_frame_cells(Cells& cells, const SceneTrees& scene, const AreaGeometry& geometry, const Recipe& recipe,
                     const BuildOptions& options, std::span<const Ray> rays);

}  // namespace raygrain::study
