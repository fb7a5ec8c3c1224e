#include "geometry/frame_polygon.h"

#include <algorithm>
#include <cmath>

#include "geometry/cut_polygon.h"

namespace raygrain {
namespace {

Vec3d largest_components(const FramePolygon& polygon) {
  Vec3d largest;
  for (size_t i = 0; i < polygon.count; ++i) {
    const Vec3d p = polygon.corners[i];
    largest = component_max(largest, {std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  return largest;
}

/// From local coordinates with z > 0 to the frame's. Local coordinates are wrong by at most `error`.
void project(FramePolygon& polygon, double error) {
  double least = polygon.corners[0].z;
  for (size_t i = 0; i < polygon.count; ++i) {
    Vec3d& p = polygon.corners[i];
    least = std::min(least, p.z);
    p = {p.x / p.z, p.y / p.z, -1 / p.z};
  }
  const Vec3d size = largest_components(polygon);
  const double shift = 2 * error / least;
  polygon.padding = {shift * (1 + size.x) + 0x1p-50 * size.x, shift * (1 + size.y) + 0x1p-50 * size.y,
                     (shift + 0x1p-50) / least};
}

}  // namespace

double largest_component(Vec3d v) {
  return std::max(std::max(std::abs(v.x), std::abs(v.y)), std::abs(v.z));
}

Vec3d to_local(const RayFrame& frame, Vec3d point) {
  const Vec3d v = point - frame.center;
  return {dot(frame.rows[0], v), dot(frame.rows[1], v), dot(frame.rows[2], v)};
}

FramePolygon frame_polygon(const RayFrame& frame, Vec3 a, Vec3 b, Vec3 c) {
  FramePolygon polygon;
  double distance = 0;
  for (const Vec3 p : {a, b, c}) {
    polygon.push(to_local(frame, to_double(p)));
    distance = std::max(distance, largest_component(to_double(p) - frame.center));
  }
  const double size = frame.norm * distance;
  if (!frame.is_projective()) {
    polygon.padding = Vec3d{1, 1, 1} * (0x1p-50 * size);
    return polygon;
  }
  const double margin = 0x1p-40 * size;
  if (margin > frame.near_z / 4) {
    polygon.is_unknown = true;
    return polygon;
  }
  cut(polygon, 2, frame.near_z - margin, -1);
  if (polygon.count != 0) project(polygon, 0x1p-46 * size);
  return polygon;
}

}  // namespace raygrain
