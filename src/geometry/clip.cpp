#include "geometry/clip.h"

#include <algorithm>
#include <cmath>

namespace raygrain {

namespace {

double cross(Vec2d a, Vec2d b) {
  return a.x * b.y - a.y * b.x;
}

Vec2d minus(Vec2d a, Vec2d b) {
  return {a.x - b.x, a.y - b.y};
}

// Sutherland and Hodgman, "Reentrant polygon clipping" (1974), one line: keeps the points with height >= 0. Rounding
// may bend a degenerate polygon so that it crosses the line more than twice; it never overflows the storage.
template <class Height, class Crossing>
ConvexPolygon clip_to_line(const ConvexPolygon& polygon, Height height, Crossing crossing) {
  ConvexPolygon result;
  const auto push = [&](Vec2d p) {
    if (result.count < ConvexPolygon::kCapacity) result.push(p);
  };
  if (polygon.count == 0) return result;
  Vec2d p = polygon.points[polygon.count - 1];
  double p_height = height(p);
  for (const Vec2d q : polygon.span()) {
    const double q_height = height(q);
    if ((p_height < 0 && q_height > 0) || (p_height > 0 && q_height < 0))
      push(crossing(p, q, p_height / (p_height - q_height)));
    if (q_height >= 0) push(q);
    p = q;
    p_height = q_height;
  }
  return result;
}

Vec2d between(Vec2d p, Vec2d q, double t) {
  return {p.x + (q.x - p.x) * t, p.y + (q.y - p.y) * t};
}

// sign = +1: keeps x <= limit; sign = -1: keeps x >= limit.
ConvexPolygon clip_x(const ConvexPolygon& polygon, double limit, double sign) {
  return clip_to_line(
      polygon, [=](Vec2d p) { return sign * (limit - p.x); },
      [=](Vec2d p, Vec2d q, double t) {
        return Vec2d{limit, between(p, q, t).y};
      });
}

ConvexPolygon clip_y(const ConvexPolygon& polygon, double limit, double sign) {
  return clip_to_line(
      polygon, [=](Vec2d p) { return sign * (limit - p.y); },
      [=](Vec2d p, Vec2d q, double t) {
        return Vec2d{between(p, q, t).x, limit};
      });
}

ConvexPolygon clip_to_rectangle(const ConvexPolygon& polygon, Vec2d lo, Vec2d hi) {
  return clip_y(clip_y(clip_x(clip_x(polygon, hi.x, 1), lo.x, -1), hi.y, 1), lo.y, -1);
}

}  // namespace

double shoelace_area(std::span<const Vec2d> points) {
  if (points.size() < 3) return 0;
  double twice = 0;
  for (size_t i = 1; i + 1 < points.size(); ++i)
    twice += cross(minus(points[i], points[0]), minus(points[i + 1], points[0]));
  return std::fabs(twice) * 0.5;
}

double polygon_area(const ConvexPolygon& polygon) {
  return shoelace_area(polygon.span());
}

ConvexPolygon clip_to_window(const ConvexPolygon& polygon, Vec2d half) {
  return clip_to_rectangle(polygon, {-half.x, -half.y}, half);
}

ConvexPolygon intersect_convex(const ConvexPolygon& a, const ConvexPolygon& b) {
  if (b.count == 0) return {};
  ConvexPolygon result = a;
  for (size_t i = 0; i < b.count; ++i) {
    const Vec2d from = b.points[i], edge = minus(b.points[(i + 1) % b.count], from);
    if (edge == Vec2d{}) continue;
    result = clip_to_line(
        result, [=](Vec2d p) { return cross(edge, minus(p, from)); }, between);
  }
  if (polygon_area(b) > 0) return result;
  // The edges of a flat polygon bound its line, not its ends.
  Vec2d lo = b.points[0], hi = lo;
  for (const Vec2d p : b.span()) {
    lo = {std::fmin(lo.x, p.x), std::fmin(lo.y, p.y)};
    hi = {std::fmax(hi.x, p.x), std::fmax(hi.y, p.y)};
  }
  return clip_to_rectangle(result, lo, hi);
}

ConvexPolygon convex_hull(std::span<Vec2d> points) {
  std::sort(points.begin(), points.end(), [](Vec2d a, Vec2d b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  const auto end = std::unique(points.begin(), points.end());
  const std::span<const Vec2d> sorted(points.begin(), end);
  ConvexPolygon hull;
  if (sorted.size() < 3) {
    for (const Vec2d p : sorted) hull.push(p);
    return hull;
  }
  const auto add = [&hull](Vec2d p, size_t fixed) {
    while (hull.count > fixed && cross(minus(hull.points[hull.count - 1], hull.points[hull.count - 2]),
                                       minus(p, hull.points[hull.count - 2])) <= 0)
      --hull.count;
    hull.push(p);
  };
  for (const Vec2d p : sorted) add(p, 1);
  const size_t lower = hull.count;
  for (size_t i = sorted.size() - 1; i-- > 0;) add(sorted[i], lower);
  --hull.count;  // the first point again
  return hull;
}

}  // namespace raygrain
