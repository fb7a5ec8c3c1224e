// Single rays as columns of a coverage: which are, and where.
#pragma once

#include "raygrain/ray.h"

#include "trace/kernels/coverage_kernels.h"

namespace raygrain {

/// +1 for directions against the light's, -1 for those along it, 0 for others. Parallel rays.
int sense_of(const CoverageGrid& grid, Vec3 direction);

/// Parallel rays of this sense. False for a ray that is no column; so below.
bool column_along(const CoverageGrid& grid, const Ray& ray, int wanted, SingleColumn& column);

/// A ray whose line passes the eye and that ends there, up to rounding.
bool column_to_eye(const CoverageGrid& grid, const Ray& ray, SingleColumn& column);

/// A ray that starts at the eye itself.
bool column_from_eye(const CoverageGrid& grid, const Ray& ray, SingleColumn& column);

}  // namespace raygrain
