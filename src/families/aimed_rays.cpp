#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "families/aim.h"
#include "families/shapes.h"

namespace raygrain {

using shapes::clamped_to_float;

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

Ray from_vertex(Aim& aim) {
  const Vec3d origin = aim.vertex();
  const Vec3d direction = aim.random.below(2) ? aim.vertex() - origin : aim.direction();
  return {to_float(origin), clamped_to_float(direction)};
}

// One or two components of the direction are zero; the line often goes through a vertex or an edge.
Ray axis_parallel(Aim& aim) {
  Vec3d target = aim.random.below(3) ? (aim.random.below(2) ? aim.vertex() : aim.edge_point()) : aim.surface_point();
  const Vec3d place = aim.place();
  const int axis = static_cast<int>(aim.random.below(3));
  Vec3d origin = target;
  origin[axis] = place[axis];
  if (aim.random.below(3) == 0) origin[(axis + 1) % 3] = place[(axis + 1) % 3];
  Ray ray{clamped_to_float(origin), clamped_to_float(target - origin)};
  if (aim.random.below(8) == 0) ray.direction[(axis + 2) % 3] = -0.0f;
  return ray;
}

Ray in_plane(Aim& aim) {
  const auto [a, b, c] = aim.triangle();
  const double steps[] = {-2, -1, -0.5, 0, 0.5, 1, 2};
  const auto step = [&] { return steps[aim.random.below(7)]; };
  const double s = step(), t = step(), along_b = step(), along_c = step();
  const Vec3d origin = a + (b - a) * s + (c - a) * t;
  return {clamped_to_float(origin), clamped_to_float((b - a) * along_b + (c - a) * along_c)};
}

// Nearly in the plane: along an edge, tilted by less than a thousandth.
Ray grazing(Aim& aim) {
  const auto [a, b, c] = aim.triangle();
  const Vec3d along = b - a, target = aim.random.below(2) ? a + along * 0.25 + (c - a) * 0.25 : a;
  const double size = std::max({std::abs(along.x), std::abs(along.y), std::abs(along.z)});
  const double tilt = std::ldexp(1.0, -10 - static_cast<int>(aim.random.below(20)));
  const Vec3d direction = along + aim.direction() * (size * tilt);
  return {clamped_to_float(target - direction * 2.0), clamped_to_float(direction)};
}

Ray on_surface(Aim& aim) {
  const Vec3d origin = aim.random.below(2) ? aim.surface_point() : aim.edge_point();
  return {clamped_to_float(origin), clamped_to_float(aim.direction())};
}

// The target lies at t = 1 (exactly, where the direction is exact), which is often an end of the interval.
Ray finite_interval(Aim& aim) {
  Ray ray = aim.towards(aim.random.below(2) ? aim.vertex() : aim.surface_point());
  const float ends[] = {-2, 0, 0.5f, 1, std::nextafter(1.0f, 0.0f), std::nextafter(1.0f, 2.0f), 3, kInf};
  ray.tmin = ends[aim.random.below(7)];
  ray.tmax = ends[aim.random.below(8)];
  if (aim.random.below(8) == 0) ray.tmin = -kInf;
  return ray;
}

Ray scaled_direction(Aim& aim) {
  Ray ray = aim.towards(aim.random.below(2) ? aim.vertex() : aim.surface_point());
  const Vec3d d = to_double(ray.direction);
  const double size = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  if (size == 0) return ray;
  const int exponent = aim.random.below(2) ? 126 - static_cast<int>(aim.random.below(20))
                                           : -126 - static_cast<int>(aim.random.below(22));
  ray.direction = clamped_to_float(d * std::ldexp(1.0, exponent - std::ilogb(size)));
  return ray;
}

Ray invalid(Aim& aim) {
  Ray ray = aim.towards(aim.surface_point());
  const int axis = static_cast<int>(aim.random.below(3));
  switch (aim.random.below(7)) {
    case 0:
      ray.origin[axis] = kNaN;
      break;
    case 1:
      ray.origin[axis] = kInf;
      break;
    case 2:
      ray.direction[axis] = kNaN;
      break;
    case 3:
      ray.direction[axis] = -kInf;
      break;
    case 4:
      ray.direction = {0, -0.0f, 0};
      break;
    case 5:
      ray.tmin = kNaN;
      break;
    default:
      ray.tmax = kNaN;
      break;
  }
  return ray;
}

Ray aimed_ray(Aim& aim, size_t kind) {
  switch (kind) {
    case 0:
      return {clamped_to_float(aim.place()), to_float(aim.direction())};
    case 1:
      return aim.towards(aim.surface_point());
    case 2:
    case 3:
      return aim.towards(aim.vertex());
    case 4:
    case 5:
      return aim.towards(aim.edge_point());
    case 6:
      return from_vertex(aim);
    case 7:
    case 8:
      return axis_parallel(aim);
    case 9:
      return in_plane(aim);
    case 10:
      return grazing(aim);
    case 11:
      return on_surface(aim);
    case 12:
      return finite_interval(aim);
    case 13:
      return scaled_direction(aim);
    default:
      return aim.random.below(3) ? aim.towards(aim.surface_point()) : invalid(aim);
  }
}

}  // namespace

std::vector<Ray> aimed_rays(const TriangleMesh& mesh, size_t count, uint64_t seed) {
  Aim aim(mesh, seed);
  std::vector<Ray> rays;
  rays.reserve(count);
  while (rays.size() < count) rays.push_back(aimed_ray(aim, rays.size() % 15));
  return rays;
}

}  // namespace raygrain
