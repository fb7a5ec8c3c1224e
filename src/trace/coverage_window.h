// Where a coverage looks.
#pragma once

#include <optional>

#include "trace/coverage_grid.h"

namespace raygrain {

/// Sets the map, the window and the errors of a grid whose mesh is set. Returns the depth below which an eye's columns
/// mean nothing (0 for parallel rays); nothing where the mesh does not fit floats or the window misses it.
std::optional<double> set_window(CoverageGrid& grid, const AreaGeometry& area);

}  // namespace raygrain
