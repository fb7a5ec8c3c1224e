// How large polygons look from the eye, in steradians. docs/theory-areas.md, "Which distribution?".
#pragma once

#include <span>

#include "raygrain/area.h"

namespace raygrain {

/// Of a convex polygon of a point area's projection: the part of the unit sphere about the eye that it covers, in
/// [0, 2 pi]; 0 for fewer than three points. The excess of a triangle after van Oosterom and Strackee, "The solid angle
/// of a plane triangle" (1983). Relative error below 2e-15 (1 + r^2) times the polygon's length over its width, r being
/// its farthest point's distance from the middle of the projection, however small the polygon is.
double solid_angle(std::span<const Vec2d> polygon);

/// Of the rectangle |x| <= half.x, |y| <= half.y.
double rectangle_solid_angle(Vec2d half);

}  // namespace raygrain
