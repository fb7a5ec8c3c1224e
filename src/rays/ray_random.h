// A stream of random numbers of its own for every ray, so that a ray depends on seed and index alone: sets of different
// counts share their beginnings, and rays can be cast in any order.
#pragma once

#include <cstddef>

#include "raygrain/vec.h"

#include "base/random.h"

namespace raygrain {

/// The stream of ray `index`. Hashed twice: neighbouring states would be the same SplitMix64 sequence, shifted.
inline Random ray_random(uint64_t seed, size_t index) {
  return Random(Random(Random(seed).next() + index).next());
}

/// A point of the disc around 0, uniform by area; z = 0. Two draws.
Vec3d random_in_disc(Random& random, double radius);

/// A direction of the spherical cap around the unit vector `axis`, uniform by solid angle; `cosine` is that of the
/// cap's half angle. Two draws.
Vec3d random_in_cap(Random& random, Vec3d axis, double cosine);

}  // namespace raygrain
