// Failures made small.
#pragma once

#include <string>

#include "verify/compare.h"

namespace raygrain::verification {

/// Drops rays, triangles and areas as long as the structure still differs about the ray (delta debugging: Zeller and
/// Hildebrandt, "Simplifying and isolating failure-inducing input", 2002). The round has
/// at least one ray.
VerifyFailure minimise(const RayStructure& structure, const Round& round, const Difference& difference);

}  // namespace raygrain::verification
