#include "raygrain/mesh.h"

#include "raygrain/error.h"

#include "base/parallel.h"
#include "geometry/triangle_boxes.h"

namespace raygrain {

Bounds triangle_bounds(const TriangleMesh& mesh, size_t triangle) {
  Bounds box;
  for (int corner = 0; corner < 3; ++corner) box.extend(mesh.vertex(triangle, corner));
  return box;
}

Vec3 triangle_centroid(const TriangleMesh& mesh, size_t triangle) {
  const Vec3d sum =
      to_double(mesh.vertex(triangle, 0)) + to_double(mesh.vertex(triangle, 1)) + to_double(mesh.vertex(triangle, 2));
  return to_float(sum / 3.0);
}

std::vector<Bounds> triangle_boxes(const TriangleMesh& mesh, unsigned threads) {
  constexpr size_t kTrianglesPerTask = 16384;
  std::vector<Bounds> boxes(mesh.triangle_count());
  parallel_for(boxes.size(), kTrianglesPerTask, threads, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) boxes[i] = triangle_bounds(mesh, i);
  });
  return boxes;
}

std::vector<Bounds> triangle_bounds(const TriangleMesh& mesh) {
  return triangle_boxes(mesh, 1);
}

std::vector<Vec3> triangle_centroids(const TriangleMesh& mesh) {
  std::vector<Vec3> centroids(mesh.triangle_count());
  for (size_t i = 0; i < centroids.size(); ++i) centroids[i] = triangle_centroid(mesh, i);
  return centroids;
}

Bounds mesh_bounds(const TriangleMesh& mesh) {
  Bounds box;
  for (size_t i = 0; i < mesh.triangle_count(); ++i) box.extend(triangle_bounds(mesh, i));
  return box;
}

void validate(const TriangleMesh& mesh, const std::string& where) {
  if (mesh.triangle_count() >= kNoTriangle || mesh.vertices.size() > kNoTriangle)
    throw Error(ErrorCode::kLimit, where, "more triangles or vertices than 32-bit indices can name", "split the mesh");
  for (size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!is_finite(mesh.vertices[i]))
      throw Error(ErrorCode::kBadMesh, where, "vertex " + std::to_string(i) + " is not finite",
                  "remove NaN and infinite coordinates");
  for (size_t i = 0; i < mesh.triangle_count(); ++i)
    for (const uint32_t index : mesh.triangles[i])
      if (index >= mesh.vertices.size())
        throw Error(ErrorCode::kBadMesh, where,
                    "triangle " + std::to_string(i) + " uses vertex " + std::to_string(index) + " of " +
                        std::to_string(mesh.vertices.size()),
                    "vertex indices start at 0 and end below the number of vertices");
}

}  // namespace raygrain
