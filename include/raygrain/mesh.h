// Indexed triangle meshes. The triangle order is the caller's and is never changed: hits report these indices.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "raygrain/bounds.h"
#include "raygrain/ray.h"

namespace raygrain {

struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;  // indices into `vertices`

  size_t triangle_count() const { return triangles.size(); }
  Vec3 vertex(size_t triangle, int corner) const { return vertices[triangles[triangle][static_cast<size_t>(corner)]]; }
};

/// The box of one triangle.
Bounds triangle_bounds(const TriangleMesh& mesh, size_t triangle);

/// A box that holds all of the triangle's part in `box` (both closed) and exceeds that part by float rounding only;
/// empty where that proves that they do not meet. Lies inside `box` and inside the triangle's own box.
Bounds clip_triangle_bounds(const TriangleMesh& mesh, size_t triangle, const Bounds& box);

/// The barycentre (mean of the three vertices) of one triangle, finite for every finite triangle.
Vec3 triangle_centroid(const TriangleMesh& mesh, size_t triangle);

/// One box per triangle, in triangle order.
std::vector<Bounds> triangle_bounds(const TriangleMesh& mesh);

/// One barycentre per triangle, in triangle order.
std::vector<Vec3> triangle_centroids(const TriangleMesh& mesh);

/// The box of all triangles (vertices that no triangle uses do not count); empty for a mesh without triangles.
Bounds mesh_bounds(const TriangleMesh& mesh);

/// Checks indices and coordinates. Throws Error (kBadMesh, `where`) naming the first index that is out of range or the
/// first vertex that is not finite.
void validate(const TriangleMesh& mesh, const std::string& where);

}  // namespace raygrain
