#include "trace/coverage_triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace raygrain {
namespace {

constexpr double kRoundoff = 0x1p-24;

/// (x, y, w) of a corner: (x, y, 1) for parallel rays, q for an eye.
using Corners = std::array<Vec3d, 3>;

struct Outline {
  std::array<Vec3d, 12> points;
  size_t count = 0;
};

/// Sutherland and Hodgman, "Reentrant polygon clipping" (1974), against dot(side, p) + offset >= 0.
Outline cut(const Outline& outline, Vec3d side, double offset = 0) {
  Outline result;
  for (size_t i = 0; i < outline.count; ++i) {
    const Vec3d a = outline.points[i], b = outline.points[(i + 1) % outline.count];
    const double at_a = dot(side, a) + offset, at_b = dot(side, b) + offset;
    if (at_a >= 0) result.points[result.count++] = a;
    if ((at_a < 0 && at_b > 0) || (at_a > 0 && at_b < 0))
      result.points[result.count++] = a + (b - a) * (at_a / (at_a - at_b));
  }
  return result;
}

/// Without the branches of lists.
double least(double a, double b, double c) {
  return std::min(std::min(a, b), c);
}
double greatest(double a, double b, double c) {
  return std::max(std::max(a, b), c);
}

void bound_parallel(const std::array<Vec3d, 3>& q, SeenTriangle& seen) {
  seen.x_lo = least(q[0].x, q[1].x, q[2].x), seen.x_hi = greatest(q[0].x, q[1].x, q[2].x);
  seen.y_lo = least(q[0].y, q[1].y, q[2].y), seen.y_hi = greatest(q[0].y, q[1].y, q[2].y);
  seen.s_lo = least(q[0].z, q[1].z, q[2].z), seen.s_hi = greatest(q[0].z, q[1].z, q[2].z);
}

/// Does the triangle come within `distance` of the eye, in all coordinates?
bool is_around_eye(const Corners& q, double distance) {
  for (int axis = 0; axis < 3; ++axis) {
    const double a = q[0][axis], b = q[1][axis], c = q[2][axis];
    if (least(a, b, c) > distance || greatest(a, b, c) < -distance) return false;
  }
  Outline outline{{q[0], q[1], q[2]}, 3};
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d side;
    side[axis] = 1;
    outline = cut(cut(outline, side, distance), -side, distance);
  }
  return outline.count > 0;
}

/// The part in the eye's window, widened a little; false where there is none.
bool bound_before_eye(const CoverageGrid& grid, const Corners& q, SeenTriangle& seen, double& nearest) {
  const double room = 0x1p-8 * grid.errors.greatest_xy;  // more than all margins of what is not too near
  const Vec3d sides[4] = {
      {1, 0, room - grid.x_lo}, {-1, 0, room + grid.x_hi}, {0, 1, room - grid.y_lo}, {0, -1, room + grid.y_hi}};
  Outline outline{{q[0], q[1], q[2]}, 3};
  for (const Vec3d side : sides) {
    const double a = dot(side, q[0]), b = dot(side, q[1]), c = dot(side, q[2]);
    if (a < 0 && b < 0 && c < 0) return false;
    if (a < 0 || b < 0 || c < 0) outline = cut(outline, side);
  }
  if (outline.count == 0) return false;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  seen.x_lo = seen.y_lo = seen.s_lo = kInfinity;
  seen.x_hi = seen.y_hi = seen.s_hi = -kInfinity;
  nearest = kInfinity;
  for (size_t i = 0; i < outline.count; ++i) {
    const Vec3d p = outline.points[i];
    nearest = std::min(nearest, p.z);
    seen.x_lo = std::min(seen.x_lo, p.x / p.z), seen.x_hi = std::max(seen.x_hi, p.x / p.z);
    seen.y_lo = std::min(seen.y_lo, p.y / p.z), seen.y_hi = std::max(seen.y_hi, p.y / p.z);
    seen.s_lo = std::min(seen.s_lo, 1 / p.z), seen.s_hi = std::max(seen.s_hi, 1 / p.z);
  }
  return true;
}

/// a x + b y + c + ahead s = 0, positive on the side of queries that have the triangle ahead.
struct PlaneOfDepth {
  double a, b, c, ahead;
};

PlaneOfDepth plane_of(bool is_eye, const Corners& corners, const std::array<Vec3d, 3>& q) {
  if (is_eye) {
    const Vec3d n = cross(corners[1] - corners[0], corners[2] - corners[0]);
    return {n.x, n.y, n.z, -dot(n, corners[0])};
  }
  const Vec3d n = cross(q[1] - q[0], q[2] - q[0]);
  return {n.x, n.y, -dot(n, q[0]), n.z};
}

/// Around each edge. Those that pass the eye's plane may be anywhere.
void bound_edges(bool is_eye, double near_z, const Corners& corners, SeenTriangle& seen) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < 3; ++i) {
    Vec3d p = corners[i], q = corners[(i + 1) % 3];
    if (is_eye) {
      if (!(p.z >= near_z && q.z >= near_z)) {
        seen.edge_boxes[i] = {-kInfinity, kInfinity, -kInfinity, kInfinity};
        continue;
      }
      p = p / p.z, q = q / q.z;
    }
    seen.edge_boxes[i] = {std::min(p.x, q.x), std::max(p.x, q.x), std::min(p.y, q.y), std::max(p.y, q.y)};
  }
}

void set_lane(CoverageTriangle& record, size_t lane, double a, double b, double c) {
  record.a[lane] = static_cast<float>(a);
  record.b[lane] = static_cast<float>(b);
  record.c[lane] = static_cast<float>(c);
}

/// Lane 3, scaled so that its error is the record's margin.
void set_plane(const CoverageGrid& grid, const PlaneOfDepth& plane, SeenTriangle& seen) {
  const ColumnErrors& e = grid.errors;
  const double slopes = std::abs(plane.a) + std::abs(plane.b);
  const double size = slopes * e.greatest_xy + std::abs(plane.c);
  double error = slopes * seen.margin + 8 * kRoundoff * size;
  if (grid.map.is_eye)
    error += 4 * (e.relative_depth + kRoundoff) * size;
  else
    error += std::abs(plane.ahead) * (e.depth + 8 * kRoundoff * e.greatest_s);
  if (!(error > 0)) return;
  const double scale = seen.margin / error;
  set_lane(seen.record, 3, plane.a * scale, plane.b * scale, plane.c * scale);
  seen.record.ahead = static_cast<float>(plane.ahead * scale);
  if (!(std::abs(plane.ahead) * grid.errors.greatest_s > 0x1p-16 * size)) return;
  seen.has_plane = true;
  seen.record.per_ahead = -1 / seen.record.ahead;
  seen.slope_x = -plane.a / plane.ahead;
  seen.slope_y = -plane.b / plane.ahead;
  seen.offset = -plane.c / plane.ahead;
  seen.plane_error = 2 * error / std::abs(plane.ahead);
}

/// Lanes 0-2 of a triangle that is (nearly) a line to the light: a strip along it. Never sure.
void set_strip(const CoverageGrid& grid, const PlaneOfDepth& plane, SeenTriangle& seen) {
  const double length = std::sqrt(plane.a * plane.a + plane.b * plane.b);
  if (!(length * 4 * grid.errors.greatest_xy > std::abs(plane.c))) return;
  const double a = plane.a / length, b = plane.b / length;
  const double middle = (plane.c + plane.ahead * (seen.s_lo + seen.s_hi) / 2) / length;
  const double width = seen.margin / 2;
  set_lane(seen.record, 0, a, b, middle + width);
  set_lane(seen.record, 1, -a, -b, -middle + width);
}

double length_of(Vec3d p) {
  return raygrain::length(p);
}

bool set_edges(const CoverageGrid& grid, const Corners& corners, double turn, SeenTriangle& seen) {
  for (size_t i = 0; i < 3; ++i) {
    const Vec3d p = corners[i], q = corners[(i + 1) % 3], n = cross(p, q) * turn;
    const double length = std::sqrt(n.x * n.x + n.y * n.y);
    const double scale = std::max(length, std::abs(n.z) / (4 * grid.errors.greatest_xy));
    const double size = grid.map.is_eye ? length_of(p) * length_of(q) : grid.errors.greatest_xy;
    if (!(scale > 0x1p-26 * size)) return false;  // too short for its direction to be known well
    seen.edges[i] = {n.x / scale, n.y / scale, n.z / scale};
  }
  for (size_t i = 0; i < 3; ++i) set_lane(seen.record, i, seen.edges[i][0], seen.edges[i][1], seen.edges[i][2]);
  return true;
}

std::array<Vec3d, 3> turned_corners(const CoverageGrid& grid, uint32_t id) {
  return {grid.map.turned(grid.mesh->vertex(id, 0)), grid.map.turned(grid.mesh->vertex(id, 1)),
          grid.map.turned(grid.mesh->vertex(id, 2))};
}

Seen bound(const CoverageGrid& grid, double near_z, const std::array<Vec3d, 3>& q, SeenTriangle& seen) {
  const ColumnErrors& e = grid.errors;
  if (grid.map.is_eye) {
    if (is_around_eye(q, e.end)) return Seen::kNear;
    double nearest = 0;
    if (!bound_before_eye(grid, q, seen, nearest)) return Seen::kNothing;
    if (!(nearest >= near_z)) return Seen::kNear;
  } else {
    bound_parallel(q, seen);
  }
  seen.margin = 1.25 * (e.place + e.evaluation + (grid.map.is_eye ? e.drift * seen.s_hi : e.drift));
  const bool is_outside = seen.x_hi < grid.x_lo - seen.margin || seen.x_lo > grid.x_hi + seen.margin ||
                          seen.y_hi < grid.y_lo - seen.margin || seen.y_lo > grid.y_hi + seen.margin;
  return is_outside ? Seen::kNothing : Seen::kSeen;
}

}  // namespace

Seen place_in_window(const CoverageGrid& grid, double near_z, uint32_t id, SeenTriangle& seen) {
  return bound(grid, near_z, turned_corners(grid, id), seen);
}

Seen look_at(const CoverageGrid& grid, double near_z, uint32_t id, SeenTriangle& seen) {
  const ColumnErrors& e = grid.errors;
  const std::array<Vec3d, 3> q = turned_corners(grid, id);
  if (const Seen found = bound(grid, near_z, q, seen); found != Seen::kSeen) return found;
  Corners corners = q;
  if (!grid.map.is_eye)
    for (Vec3d& corner : corners) corner.z = 1;
  bound_edges(grid.map.is_eye, near_z, corners, seen);
  seen.has_plane = false;
  seen.record = {};
  seen.record.margin = static_cast<float>(seen.margin * 1.0001);
  seen.record.id = id;
  PlaneOfDepth plane = plane_of(grid.map.is_eye, corners, q);
  const double spread = std::abs(plane.ahead) * (seen.s_hi - seen.s_lo) / 2;
  const double length = std::sqrt(plane.a * plane.a + plane.b * plane.b);
  const bool is_line = spread <= length * seen.margin / 4 && seen.s_hi > seen.s_lo;
  // "ahead" < 0: a query further from the light has the triangle ahead of it.
  const double sign = plane.ahead > 0 ? -1 : 1;
  plane = {plane.a * sign, plane.b * sign, plane.c * sign, plane.ahead * sign};
  const double edge_turn = grid.map.is_eye ? sign : -sign;
  seen.is_clear = plane.ahead != 0 && !is_line && set_edges(grid, corners, edge_turn, seen);
  if (seen.is_clear)
    set_plane(grid, plane, seen);
  else if (is_line)
    set_strip(grid, plane, seen);
  seen.s_lo -= e.depth_error(seen.s_lo), seen.s_hi += e.depth_error(seen.s_hi);
  return Seen::kSeen;
}

bool SeenTriangle::may_touch(double x, double y, double half) const {
  if (!is_clear) return true;
  for (const auto& edge : edges) {
    const double reach = (std::abs(edge[0]) + std::abs(edge[1])) * (half + margin) + margin;
    if (edge[0] * x + edge[1] * y + edge[2] < -reach) return false;
  }
  return true;
}

}  // namespace raygrain
