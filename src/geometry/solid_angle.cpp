#include "geometry/solid_angle.h"

#include <cmath>

#include "base/trigonometry.h"

namespace raygrain {

namespace {

/// The unit vector to a point of the projection; `scale` is its z.
struct Sight {
  double x, y, scale;

  explicit Sight(Vec2d p) : scale(1 / std::sqrt(1 + (p.x * p.x + p.y * p.y))) { x = p.x * scale, y = p.y * scale; }
};

double dot(const Sight& a, const Sight& b) {
  return a.x * b.x + a.y * b.y + a.scale * b.scale;
}

double cross(Vec2d origin, Vec2d a, Vec2d b) {
  return (a.x - origin.x) * (b.y - origin.y) - (a.y - origin.y) * (b.x - origin.x);
}

}  // namespace

// A triangle's angle is twice that of 1 + ab + bc + ca + i det(a, b, c), its corners being unit vectors. On the plane
// z = 1 the determinant is twice the triangle's area, so nothing cancels in it. Angles of a fan of triangles add up
// where these numbers are multiplied: one arctangent does for all.
double solid_angle(std::span<const Vec2d> polygon) {
  if (polygon.size() < 3) return 0;
  const Sight first(polygon[0]);
  Sight last(polygon[1]);
  double last_dot = dot(first, last), real = 1, imaginary = 0;
  for (size_t i = 2; i < polygon.size(); ++i) {
    const Sight next(polygon[i]);
    const double next_dot = dot(first, next);
    const double cosines = 1 + last_dot + dot(last, next) + next_dot;
    const double volume = cross(polygon[0], polygon[i - 1], polygon[i]) * (first.scale * last.scale * next.scale);
    const double turned = real * cosines - imaginary * volume;
    imaginary = real * volume + imaginary * cosines;
    real = turned;
    last = next, last_dot = next_dot;
  }
  return 2 * arctangent(std::fabs(imaginary), real);
}

double rectangle_solid_angle(Vec2d half) {
  return 4 * arctangent(half.x * half.y, std::sqrt(1 + (half.x * half.x + half.y * half.y)));
}

}  // namespace raygrain
