// Influence areas around and inside a mesh, and rays that put them to the test.
#pragma once

#include <cstdint>
#include <vector>

#include "raygrain/area.h"
#include "raygrain/mesh.h"
#include "raygrain/ray.h"

namespace raygrain::test {

/// Plane and point areas: covering the mesh, cutting through it, one behind the other, overlapping, beside it.
std::vector<InfluenceArea> areas_around(const TriangleMesh& mesh, uint64_t seed);

/// Rays of the areas: cast by them, starting on their borders, aimed from inside them at vertices, edges and faces,
/// along their directions through such points, towards their eyes.
std::vector<Ray> rays_of_areas(const TriangleMesh& mesh, const std::vector<InfluenceArea>& areas, size_t count,
                               uint64_t seed);

/// Rays from a point towards vertices, edge points and face points of the mesh.
std::vector<Ray> rays_from(Vec3 origin, const TriangleMesh& mesh, size_t count, uint64_t seed);

/// Removes rays that are equal bit by bit; the order is lost.
void keep_distinct(std::vector<Ray>& rays);

}  // namespace raygrain::test
