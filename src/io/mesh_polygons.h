// What the mesh readers hand over: polygons as a file holds them, before they become triangles.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "raygrain/io.h"
#include "raygrain/mesh.h"

namespace raygrain {

struct PolygonMesh {
  std::vector<Vec3> vertices;
  std::vector<uint32_t> corners;  // vertex indices, polygon after polygon
  std::vector<uint32_t> sizes;    // corners of each polygon, at least 3
  LoadReport dropped;
};

/// n - 2 triangles for each polygon of n corners, in the polygons' order. Convex polygons become a fan around their
/// first corner, others are cut ear by ear in the coordinate plane that shows them largest; what has no ear (a polygon
/// that crosses itself) still gives n - 2 triangles. Indices must be in range. Throws Error (kLimit, `where`) for
/// polygons that are not convex and have more than 20,000 corners.
TriangleMesh triangulated(PolygonMesh mesh, const std::string& where);

/// Merges vertices with the same bits; each keeps the place of its first use by a triangle. Unused ones go.
TriangleMesh welded(const TriangleMesh& mesh);

/// Readers of whole files. Text coordinates become the nearest float, doubles are rounded once, indices and counts are
/// checked. Throw Error: kMalformed (with file:line for text), kUnsupported, kBadMesh.
PolygonMesh parse_obj(const std::string& bytes, const std::string& path);
PolygonMesh parse_ply(const std::string& bytes, const std::string& path);
PolygonMesh parse_stl(const std::string& bytes, const std::string& path);

/// Everything else that Assimp knows, with node transforms applied. Throws Error: kMalformed, kUnsupported, kBadMesh.
PolygonMesh import_with_assimp(const std::string& path);

/// The faces, lines and points that the meshes of a glTF 2 file announce; nothing for other files.
std::optional<uint64_t> announced_gltf_faces(const std::string& path);

/// The endings that Assimp reads, like "3ds, blend, ...".
std::string assimp_endings();
bool assimp_knows(const std::string& ending);

}  // namespace raygrain
