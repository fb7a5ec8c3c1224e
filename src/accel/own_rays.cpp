#include "accel/own_rays.h"

#include <cmath>

namespace raygrain {
namespace {

constexpr double kLargestSine = 1e-6;

bool is_along(Vec3d direction, Vec3d axis) {
  const Vec3d beside = cross(direction, axis);
  return dot(beside, beside) <= kLargestSine * kLargestSine * dot(direction, direction) * dot(axis, axis);
}

}  // namespace

bool is_own_ray(const AreaGeometry& area, const Ray& ray) {
  if (!is_valid(ray)) return false;
  const Frame& frame = area.frame();
  const Vec2d half = area.window_half();
  const Vec3d direction = to_double(ray.direction), place = to_double(ray.origin) - frame.origin;
  if (area.is_plane()) {
    const Vec3d at = to_local(frame, to_double(ray.origin));
    if (is_along(direction, frame.forward) && std::abs(at.x) <= half.x && std::abs(at.y) <= half.y) return true;
  } else if (is_along(direction, place)) {
    const Vec3d at = to_local_direction(frame, place == Vec3d{} ? direction : place);
    if (at.z > 0 && std::abs(at.x) <= half.x * at.z && std::abs(at.y) <= half.y * at.z) return true;
  }
  return area.serves(ray);
}

}  // namespace raygrain
