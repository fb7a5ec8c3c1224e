// Brute force: every triangle in turn.
#pragma once

#include "raygrain/mesh.h"
#include "raygrain/ray.h"
#include "raygrain/triangle.h"

namespace raygrain {

/// The nearest hit as `intersect(ray, a, b, c, hit)` decides on each triangle; none for invalid rays.
template <class Intersect>
Hit nearest_of_all(const TriangleMesh& mesh, const Ray& ray, const Intersect& intersect) {
  Hit nearest;
  if (!is_valid(ray)) return nearest;
  for (uint32_t i = 0; i < mesh.triangle_count(); ++i) {
    Hit hit;
    if (!intersect(ray, mesh.vertex(i, 0), mesh.vertex(i, 1), mesh.vertex(i, 2), hit)) continue;
    hit.triangle = i;
    if (is_nearer(hit, nearest)) nearest = hit;
  }
  return nearest;
}

}  // namespace raygrain
