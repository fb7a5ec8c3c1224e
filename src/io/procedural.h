// The generators behind generate_scene, one file each. Sizes are in range when they are called.
#pragma once

#include <cstdint>

#include "raygrain/mesh.h"

namespace raygrain {

/// size x size buildings, in blocks of four on a street grid; about 440 triangles per building.
TriangleMesh make_city(uint32_t size, uint64_t seed);

/// size x size trees on rolling ground; about 400 triangles per tree.
TriangleMesh make_forest(uint32_t size, uint64_t seed);

/// A square kilometre of mountains in size x size cells; 2 triangles per cell. Larger sizes refine the same mountains.
TriangleMesh make_terrain(uint32_t size, uint64_t seed);

/// The random triangles of the paper's tests; the thousand are drawn after the hundred from one engine.
TriangleMesh make_random_100(uint32_t seed);
TriangleMesh make_random_1000(uint32_t seed);

}  // namespace raygrain
