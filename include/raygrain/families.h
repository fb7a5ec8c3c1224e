// Named families of meshes, areas and rays where ray tracers fail: what the tests and `raygrain verify` loop over, and
// anybody may try on a structure of their own. The same seed gives the same bytes on every machine.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "raygrain/area.h"
#include "raygrain/mesh.h"
#include "raygrain/ray.h"

namespace raygrain {

struct NamedMesh {
  std::string name;  // e.g. "closed_sphere"
  TriangleMesh mesh;
  bool closed = false;  // watertight: every edge is used as often in one direction as in the other
  Vec3 inside{};        // a point well inside, for closed meshes
};

/// One mesh of each family: closed, open, empty, one_triangle, sliver, degenerate, duplicates, huge, tiny, far,
/// large_triangles, soup ...: at most a few hundred triangles each, so that brute force stays cheap.
std::vector<NamedMesh> mesh_families(uint64_t seed);

/// Closed surfaces alone: boxes, spheres, tori, noise, and cuts as thin as Boolean operations leave, scaled by 1e-6 to
/// 1e6, and moved 1e6 from the origin.
std::vector<NamedMesh> closed_mesh_families(uint64_t seed);

/// A mesh of a family that the seed chooses, turned, scaled and moved as the seed says, with about `triangles`
/// triangles (some families have only one, closed ones at least 12).
NamedMesh random_family_mesh(size_t triangles, uint64_t seed);

/// Plane and point areas: covering the mesh, cutting through it, one behind the other, overlapping, beside it; one with
/// a field of view of 120 to 179.9 degrees.
std::vector<InfluenceArea> areas_around(const TriangleMesh& mesh, uint64_t seed);

/// A mix: random, aimed at edges, at vertices, axis-parallel, lying in faces' planes, grazing, starting on surfaces,
/// with finite [tmin, tmax], a few invalid (NaN, zero direction).
std::vector<Ray> aimed_rays(const TriangleMesh& mesh, size_t count, uint64_t seed);

/// A mix of what is rarer: from far away, of tiny and of huge directions, past silhouettes, along edges, nearly along
/// axes, a float's step beside edges and vertices, from a hair above surfaces.
std::vector<Ray> extreme_rays(const TriangleMesh& mesh, size_t count, uint64_t seed);

/// The same rays with intervals that begin or end exactly at what they hit, or one float before or behind it; rays that
/// hit nothing get any. `hits` has the size of `rays`.
std::vector<Ray> window_rays(std::span<const Ray> rays, std::span<const Hit> hits, uint64_t seed);

/// Rays of the areas: cast by them, starting on their borders, aimed from inside them at vertices, edges and faces,
/// along their directions through such points, towards their eyes.
std::vector<Ray> rays_of_areas(const TriangleMesh& mesh, const std::vector<InfluenceArea>& areas, size_t count,
                               uint64_t seed);

/// Rays from a point towards vertices, edge points and face points of the mesh.
std::vector<Ray> rays_from(Vec3 origin, const TriangleMesh& mesh, size_t count, uint64_t seed);

/// Points on the mesh (vertices, edges, faces), before and behind them along `direction`, and anywhere: where rays that
/// share a direction start. Without a direction (zero): around the mesh.
std::vector<Vec3> points_near(const TriangleMesh& mesh, Vec3 direction, size_t count, uint64_t seed);

/// Removes rays that are equal bit by bit; the order is lost.
void keep_distinct(std::vector<Ray>& rays);

}  // namespace raygrain
