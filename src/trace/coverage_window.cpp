// The map of a coverage, its window, and the errors inside it: docs/theory-coverage.md, "Margins".
#include "trace/coverage_window.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "trace/coverage_map.h"

namespace raygrain {
namespace {

constexpr double kRoundoff = 0x1p-24;

struct Rectangle {
  double x_lo, x_hi, y_lo, y_hi;
};

template <class Vector>
double largest(Vector a) {
  return std::max<double>({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
}

Rectangle rectangle_of(const CoverageGrid& grid, std::span<const Vec3> points) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Rectangle r{kInfinity, -kInfinity, kInfinity, -kInfinity};
  for (const Vec3 p : points) {
    const Vec3d q = grid.map.turned(p);
    r = {std::min(r.x_lo, q.x), std::max(r.x_hi, q.x), std::min(r.y_lo, q.y), std::max(r.y_hi, q.y)};
  }
  return r;
}

double row_length(Vec3d row) {
  return std::abs(row.x) + std::abs(row.y) + std::abs(row.z);
}

/// How far from the map's center, along any axis of the world, a query with such coordinates in the map may be.
double farthest_query(const ColumnMap& map, double greatest_xy, double greatest_s) {
  const auto [x, y, s] = map.rows;
  const double volume = std::abs(dot(x, cross(y, s)));
  return ((largest(cross(y, s)) + largest(cross(s, x))) * greatest_xy + largest(cross(x, y)) * greatest_s) / volume;
}

/// The window of parallel rays and the errors inside it.
bool set_parallel_window(CoverageGrid& grid, const AreaGeometry& area, const Bounds& box) {
  std::vector<Vec3> corners;
  for (const Vec3d corner : area.region().outer_corners) corners.push_back(to_float(corner));
  const Rectangle window = rectangle_of(grid, corners);
  const Rectangle scene = rectangle_of(grid, grid.mesh->vertices);
  const double reach = std::max(largest(extent(box)), 0x1p-100) / 2;
  const double rows =
      std::max({row_length(grid.map.rows[0]), row_length(grid.map.rows[1]), row_length(grid.map.rows[2])});
  ColumnErrors& e = grid.errors;
  e.greatest_s = 2 * reach;
  for (const Vec3 corner : corners) e.greatest_s = std::max(e.greatest_s, std::abs(grid.map.turned(corner).z) * 1.01);
  e.greatest_s = std::min(e.greatest_s, 16 * reach);
  e.greatest_xy = 2 * rows * reach;
  const double farthest = farthest_query(grid.map, e.greatest_xy, e.greatest_s);
  e.place = 8 * kRoundoff * rows * farthest + 16 * kRoundoff * e.greatest_xy;
  e.drift = kMostSlope * (e.greatest_s + reach * rows);
  e.evaluation = 32 * kRoundoff * e.greatest_xy;
  e.depth = 8 * kRoundoff * rows * farthest;
  const double room = 4 * (e.place + e.drift + e.evaluation);
  grid.x_lo = static_cast<float>(std::max(window.x_lo, scene.x_lo) - room);
  grid.x_hi = static_cast<float>(std::min(window.x_hi, scene.x_hi) + room);
  grid.y_lo = static_cast<float>(std::max(window.y_lo, scene.y_lo) - room);
  grid.y_hi = static_cast<float>(std::min(window.y_hi, scene.y_hi) + room);
  grid.is_free_beside =
      window.x_lo <= scene.x_lo && window.x_hi >= scene.x_hi && window.y_lo <= scene.y_lo && window.y_hi >= scene.y_hi;
  grid.s_lo = static_cast<float>(-e.greatest_s), grid.s_hi = static_cast<float>(e.greatest_s);
  return grid.x_lo < grid.x_hi && grid.y_lo < grid.y_hi;
}

/// The window of an eye and the errors inside it. Returns the depth below which columns mean nothing.
double set_eye_window(CoverageGrid& grid, const AreaGeometry& area) {
  const auto& shape = std::get<PointArea>(area.area().shape);
  grid.map.is_eye = true;
  grid.map.center = shape.eye;
  grid.map.rows = {area.frame().right, area.frame().up, area.frame().forward};
  double farthest = shape.far_z;
  for (const Vec3 p : grid.mesh->vertices) farthest = std::max(farthest, grid.map.turned(p).z);
  farthest *= 1.01;
  const Vec2d half = area.window_half();
  ColumnErrors& e = grid.errors;
  const double size = std::max(half.x, half.y), slant = std::sqrt(1 + 2 * size * size);
  e.greatest_xy = size;
  e.place = (16 * slant * (1 + size) + 16 * size) * kRoundoff;
  e.drift = 1.25 * kMostOffset * slant * (1 + size) * farthest;
  e.end = 4 * kMostOffset * slant * farthest;
  e.evaluation = (16 + 24 * size) * kRoundoff;
  e.relative_depth = 32 * slant * kRoundoff;
  grid.x_lo = static_cast<float>(-half.x), grid.x_hi = static_cast<float>(half.x);
  grid.y_lo = static_cast<float>(-half.y), grid.y_hi = static_cast<float>(half.y);
  const double near_z = std::max<double>(shape.near_z, 0x1p10 * e.drift / size);
  e.greatest_s = 1 / near_z;
  grid.s_lo = static_cast<float>(1 / farthest), grid.s_hi = static_cast<float>(1 / near_z);
  return near_z;
}

/// Products of coordinates must neither overflow nor vanish.
bool fits_floats(const Bounds& box) {
  const Vec3 lo = box.lo, hi = box.hi, size = extent(box);
  const float farthest =
      std::max({std::abs(lo.x), std::abs(lo.y), std::abs(lo.z), std::abs(hi.x), std::abs(hi.y), std::abs(hi.z)});
  return farthest <= 0x1p30f && std::max({size.x, size.y, size.z}) >= 0x1p-30f;
}

}  // namespace

std::optional<double> set_window(CoverageGrid& grid, const AreaGeometry& area) {
  const Bounds box = mesh_bounds(*grid.mesh);
  if (is_empty(box) || !fits_floats(box)) return {};
  double near_z = 0;
  if (area.is_plane()) {
    grid.map = choose_parallel_map(*grid.mesh, std::get<PlaneArea>(area.area().shape).direction, center(box));
    if (!set_parallel_window(grid, area, box)) return {};
  } else {
    near_z = set_eye_window(grid, area);
  }
  for (size_t i = 0; i < 3; ++i) grid.map.float_rows[i] = to_float(grid.map.rows[i]);
  return near_z;
}

}  // namespace raygrain
