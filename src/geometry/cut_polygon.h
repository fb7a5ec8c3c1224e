// Sutherland and Hodgman, "Reentrant polygon clipping" (1974), for planes across an axis.
#pragma once

#include "raygrain/vec.h"

namespace raygrain {

/// Keeps the part with sign * x[axis] <= sign * limit. A polygon has `corners`, their `count`, and push(corner).
template <class Polygon>
void cut(Polygon& polygon, int axis, double limit, double sign) {
  const auto is_inside = [&](Vec3d p) { return sign * p[axis] <= sign * limit; };
  bool all_inside = true;
  for (size_t i = 0; i < polygon.count; ++i) all_inside = all_inside && is_inside(polygon.corners[i]);
  if (all_inside) return;
  Polygon result = polygon;
  result.count = 0;
  for (size_t i = 0; i < polygon.count; ++i) {
    const Vec3d a = polygon.corners[i], b = polygon.corners[i + 1 < polygon.count ? i + 1 : 0];
    if (is_inside(a)) result.push(a);
    if (is_inside(a) == is_inside(b)) continue;
    Vec3d crossing = a + (b - a) * ((limit - a[axis]) / (b[axis] - a[axis]));
    crossing[axis] = limit;
    result.push(crossing);
  }
  polygon = result;
}

}  // namespace raygrain
