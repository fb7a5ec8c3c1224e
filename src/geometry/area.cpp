#include "raygrain/area.h"

#include <cmath>

#include "base/trigonometry.h"

namespace raygrain {

namespace {

double largest_component(Vec3d v) {
  return std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z)));
}

// |cos| of the angle between two vectors; NaN when one is zero or not finite.
double absolute_cosine(Vec3d a, Vec3d b) {
  a = a / largest_component(a);
  b = b / largest_component(b);
  return std::fabs(dot(a, b)) / (length(a) * length(b));
}

}  // namespace

AreaGeometry::AreaGeometry(const InfluenceArea& area) : area_(area) {
  validate(area, area.name.empty() ? "influence area" : area.name);
  if (const auto* plane = std::get_if<PlaneArea>(&area.shape)) {
    frame_ = make_frame(to_double(plane->center), to_double(plane->direction), to_double(plane->up));
    window_half_ = {static_cast<double>(plane->half_width), static_cast<double>(plane->half_height)};
    far_z_ = static_cast<double>(plane->depth);
    region_ = oriented_box_region(frame_, window_half_.x, window_half_.y, far_z_);
  } else {
    const auto& point = std::get<PointArea>(area.shape);
    frame_ = make_frame(to_double(point.eye), to_double(point.forward), to_double(point.up));
    window_half_ = {tangent(radians(static_cast<double>(point.fov_x) / 2)),
                    tangent(radians(static_cast<double>(point.fov_y) / 2))};
    near_z_ = static_cast<double>(point.near_z);
    far_z_ = static_cast<double>(point.far_z);
    region_ = frustum_region(frame_, window_half_.x, window_half_.y, near_z_, far_z_);
  }
}

Vec3d AreaGeometry::ray_direction(Vec3d point) const {
  if (is_plane() || point == frame_.origin) return frame_.forward;
  return point - frame_.origin;
}

bool AreaGeometry::is_direction_affine(const Ray& ray) const {
  // A float direction of unit length is off by up to 2^-24, which changes the cosine by 2^-49.
  constexpr double kRounding = 0x1p-46;
  const Vec3d origin = to_double(ray.origin);
  if (!is_plane() && origin == frame_.origin) return is_valid(ray);
  const double cosine = absolute_cosine(to_double(ray.direction), ray_direction(origin));
  return cosine >= 1 - static_cast<double>(area_.tolerance) - kRounding;  // false for NaN
}

bool AreaGeometry::serves(const Ray& ray) const {
  return is_valid(ray) && ray.tmin >= 0 && contains(region_, ray.origin) && is_direction_affine(ray);
}

}  // namespace raygrain
