#include "verify/oracle.h"

#include "raygrain/triangle.h"

namespace raygrain::verification {
namespace {

Ray whole_line(Ray ray) {
  ray.tmin = -kInf;
  ray.tmax = kInf;
  return ray;
}

/// Is the line met on the edge from a to b? Turned by corners, each weight is reported once as v, which is zero there
/// (and where it underflows: then the line counts as touching, and is left out).
bool touches(const Ray& line, const std::array<Vec3, 3>& t) {
  for (size_t k = 0; k < 3; ++k) {
    Hit hit;
    if (intersect_triangle(line, t[k], t[(k + 1) % 3], t[(k + 2) % 3], hit) && hit.v == 0) return true;
  }
  return false;
}

}  // namespace

Oracle::Oracle(const TriangleMesh& mesh) {
  corners_.reserve(mesh.triangle_count());
  for (size_t i = 0; i < mesh.triangle_count(); ++i)
    corners_.push_back({mesh.vertex(i, 0), mesh.vertex(i, 1), mesh.vertex(i, 2)});
}

Hit Oracle::nearest(const Ray& ray) const {
  Hit nearest;
  if (!is_valid(ray)) return nearest;
  for (uint32_t i = 0; i < corners_.size(); ++i) {
    Hit hit;
    if (!intersect_triangle(ray, corners_[i][0], corners_[i][1], corners_[i][2], hit)) continue;
    hit.triangle = i;
    if (is_nearer(hit, nearest)) nearest = hit;
  }
  return nearest;
}

Oracle::Crossings Oracle::crossings(const Ray& ray) const {
  Crossings result;
  const Ray line = whole_line(ray);
  for (const auto& t : corners_) {
    Hit hit;
    if (!intersect_triangle(line, t[0], t[1], t[2], hit)) continue;
    ++result.count;
    if (touches(line, t)) result.touches_edge = true;
  }
  return result;
}

bool Oracle::touches_any_edge(const Ray& ray) const {
  const Ray line = whole_line(ray);
  // Each edge with an apex of its own beside it: one of the two is not in the line's plane.
  for (const auto& t : corners_)
    for (size_t k = 0; k < 3; ++k)
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 apex = t[k];
        apex[axis] = apex[axis] > 0 ? -apex[axis] - 1 : -apex[axis] + 1;
        Hit hit;
        if (intersect_triangle(line, t[k], t[(k + 1) % 3], apex, hit) && hit.v == 0) return true;
      }
  return false;
}

}  // namespace raygrain::verification
