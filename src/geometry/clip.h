// Convex polygons: hulls and clipping to a rectangle.
#pragma once

#include <span>

#include "raygrain/area.h"

namespace raygrain {

/// The convex hull of up to 31 points, counterclockwise (Andrew, "Another efficient algorithm for convex hulls in two
/// dimensions", 1979). Sorts `points`.
ConvexPolygon convex_hull(std::span<Vec2d> points);

/// The part of a convex polygon with |x| <= half.x, |y| <= half.y. New points lie on the rectangle exactly.
ConvexPolygon clip_to_window(const ConvexPolygon& polygon, Vec2d half);

/// Shoelace area of a counterclockwise polygon; 0 for fewer than three points.
double shoelace_area(std::span<const Vec2d> points);

}  // namespace raygrain
