// The definition of a hit in 128-bit integers, for coordinates that are not too different in size: nearly all of those
// that double precision cannot decide. Some twenty times as fast as integers of any size.
#pragma once

#include <optional>

#include "raygrain/ray.h"

namespace raygrain {

/// As intersect_triangle_exact; nothing where the integers do not fit.
std::optional<bool> intersect_triangle_small(const Ray& ray, Vec3 a, Vec3 b, Vec3 c, Hit& hit);

}  // namespace raygrain
