#include "trace/coverage_columns.h"

#include <algorithm>
#include <cmath>

namespace raygrain {
namespace {

Vec3d turn(const ColumnMap& map, Vec3d v) {
  return {dot(map.rows[0], v), dot(map.rows[1], v), dot(map.rows[2], v)};
}

/// From the direction in the map.
int sense_of(Vec3d q) {
  const double along = std::abs(q.z);
  if (!(along >= 0x1p-60 && along <= 0x1p60) || std::max(std::abs(q.x), std::abs(q.y)) > kMostSlope * along) return 0;
  return q.z > 0 ? 1 : -1;
}

}  // namespace

int sense_of(const CoverageGrid& grid, Vec3 direction) {
  return sense_of(turn(grid.map, to_double(direction)));
}

// In double precision: better than the errors that the grid allows for.
bool column_along(const CoverageGrid& grid, const Ray& ray, int wanted, SingleColumn& column) {
  const Vec3d direction = turn(grid.map, to_double(ray.direction));
  if (sense_of(direction) != wanted) return false;
  const Vec3d q = grid.map.turned(ray.origin);
  column = {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z),
            static_cast<float>(q.z + direction.z * static_cast<double>(ray.tmax))};
  return column.s >= grid.s_lo && column.s <= grid.s_hi;
}

bool column_to_eye(const CoverageGrid& grid, const Ray& ray, SingleColumn& column) {
  const Vec3d to_eye = to_double(grid.map.center) - to_double(ray.origin);
  // Most of several frusta about one eye are done with here: the grid's own test of its window is no wider.
  constexpr double kRoom = 1 + 0x1p-20;
  const double x_most = kRoom * static_cast<double>(grid.x_hi), y_most = kRoom * static_cast<double>(grid.y_hi);
  const auto& rows = grid.map.rows;
  const double z = -dot(rows[2], to_eye);
  if (!(z > 0)) return false;
  const Vec3d q{-dot(rows[0], to_eye), -dot(rows[1], to_eye), z};
  const bool in_x = std::abs(q.x) <= x_most * z, in_y = std::abs(q.y) <= y_most * z;
  if (!(in_x & in_y)) return false;
  const Vec3d direction = to_double(ray.direction);
  const double distance = dot(to_eye, to_eye), size = dot(direction, direction), along = dot(to_eye, direction);
  if (!(size >= 0x1p-120 && size <= 0x1p120 && distance <= 0x1p120 && along > 0)) return false;
  const Vec3d beside = cross(to_eye, direction);
  if (!(dot(beside, beside) <= 0.99 * kMostOffset * kMostOffset * distance * size)) return false;
  const double end = static_cast<double>(ray.tmax) * size;  // against `along`, where the ray passes the eye
  if (!(end >= along * (1 - kMostOffset) && end <= along * (1 + kMostOffset))) return false;
  const double s = 1 / q.z;
  column = {static_cast<float>(q.x * s), static_cast<float>(q.y * s), static_cast<float>(s), kInf};
  return column.s >= grid.s_lo && column.s <= grid.s_hi;
}

bool column_from_eye(const CoverageGrid& grid, const Ray& ray, SingleColumn& column) {
  if (ray.origin != grid.map.center) return false;
  const Vec3d q = turn(grid.map, to_double(ray.direction));
  if (!(q.z >= 0x1p-60 && q.z <= 0x1p60)) return false;
  column = {static_cast<float>(q.x / q.z), static_cast<float>(q.y / q.z), kInf, 0};
  return true;
}

}  // namespace raygrain
