// The oracle: no tree, no bounds, no order. Whatever else the library does must agree with it bit for bit.
#include "raygrain/trace.h"
#include "raygrain/triangle.h"

#include "trace/nearest_of_all.h"

namespace raygrain {

Hit intersect_reference(const TriangleMesh& mesh, const Ray& ray) {
  return nearest_of_all(mesh, ray, intersect_triangle);
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
