// The box of the part of a triangle in a box. Sutherland and Hodgman, "Reentrant polygon clipping" (1974), in double
// and with planes moved outwards by more than all rounding errors; docs/theory.md proves that nothing is lost.
#include <algorithm>
#include <array>
#include <cmath>

#include "raygrain/mesh.h"

#include "geometry/cut_polygon.h"
#include "geometry/rounding.h"

namespace raygrain {

namespace {

/// A triangle cut by six planes has at most nine corners.
struct Polygon {
  std::array<Vec3d, 9> corners;
  size_t count = 0;

  void push(Vec3d p) {
    if (count < corners.size()) corners[count++] = p;
  }
};

}  // namespace

Bounds clip_triangle_bounds(const TriangleMesh& mesh, size_t triangle, const Bounds& box) {
  const Bounds whole = triangle_bounds(mesh, triangle), inside = intersected(whole, box);
  if (is_empty(inside)) return {};
  if (inside == whole) return whole;
  double largest = 0;
  Polygon polygon;
  for (int i = 0; i < 3; ++i) {
    const Vec3d p = to_double(mesh.vertex(triangle, i));
    largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    polygon.push(p);
  }
  const double margin = largest * 0x1p-40;
  for (int axis = 0; axis < 3; ++axis) {
    cut(polygon, axis, static_cast<double>(inside.lo[axis]) - margin, -1);
    cut(polygon, axis, static_cast<double>(inside.hi[axis]) + margin, 1);
  }
  if (polygon.count == 0) return {};
  Vec3d lo = polygon.corners[0], hi = lo;
  for (size_t i = 1; i < polygon.count; ++i) {
    lo = component_min(lo, polygon.corners[i]);
    hi = component_max(hi, polygon.corners[i]);
  }
  Bounds part;
  for (int axis = 0; axis < 3; ++axis) {
    part.lo[axis] = float_below(lo[axis] - margin);
    part.hi[axis] = float_above(hi[axis] + margin);
  }
  part = intersected(part, inside);
  return is_empty(part) ? Bounds{} : part;
}

}  // namespace raygrain
