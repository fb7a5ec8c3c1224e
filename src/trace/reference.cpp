// The oracle: no tree, no bounds, no order. Whatever else the library does must agree with it bit for bit.
#include "raygrain/trace.h"
#include "raygrain/triangle.h"

namespace raygrain {

Hit intersect_reference(const TriangleMesh& mesh, const Ray& ray) {
  Hit nearest;
  if (!is_valid(ray)) return nearest;
  for (uint32_t i = 0; i < mesh.triangle_count(); ++i) {
    Hit hit;
    if (!intersect_triangle(ray, mesh.vertex(i, 0), mesh.vertex(i, 1), mesh.vertex(i, 2), hit)) continue;
    hit.triangle = i;
    if (is_nearer(hit, nearest)) nearest = hit;
  }
  return nearest;
}

bool occluded_reference(const TriangleMesh& mesh, const Ray& ray) {
  if (!is_valid(ray)) return false;
  for (uint32_t i = 0; i < mesh.triangle_count(); ++i) {
    Hit hit;
    if (intersect_triangle(ray, mesh.vertex(i, 0), mesh.vertex(i, 1), mesh.vertex(i, 2), hit)) return true;
  }
  return false;
}

}  // namespace raygrain
