#include <cmath>
#include <string>

#include "raygrain/error.h"
#include "raygrain/rays.h"

#include "base/trigonometry.h"
#include "rays/ray_random.h"

namespace raygrain {
namespace {

void check_options(const AreaRays& options) {
  const std::string where = "rays of area \"" + options.area.name + '"';
  if (!(options.cone_degrees >= 0 && options.cone_degrees <= 90))
    throw Error(ErrorCode::kUsage, where, "cone_degrees is out of range", "Choose 0 to 90");
  if (!(options.jitter_radius >= 0 && std::isfinite(options.jitter_radius)))
    throw Error(ErrorCode::kUsage, where, "jitter_radius is out of range", "Choose 0 or a positive length");
}

// What all rays of a set share.
struct AreaCaster {
  AreaGeometry geometry;
  AreaRays options;
  double cone_cosine;

  explicit AreaCaster(const AreaRays& rays)
      : geometry(rays.area), options(rays), cone_cosine(sine_cosine(radians(rays.cone_degrees)).cosine) {}
};

struct LocalRay {
  Vec3d origin, direction;  // frame coordinates; the direction need not have unit length
};

// `x` and `y` are uniform in [-1, 1], `depth` in [0, 1].
LocalRay local_ray(const PlaneArea& area, double x, double y, double depth) {
  return {{x * area.half_width, y * area.half_height, depth * area.depth}, {0, 0, 1}};
}

LocalRay local_ray(const PointArea& area, Vec2d window_half, PointSpread spread, const Vec3d& uniform) {
  const double near = area.near_z, z = near + uniform.z * (area.far_z - near);
  if (spread == PointSpread::kNearPlane) {
    const Vec3d direction{uniform.x * window_half.x, uniform.y * window_half.y, 1};
    return {direction * z, direction};
  }
  const Vec3d direction = angular_direction(uniform.x * radians(area.fov_x) / 2, uniform.y * radians(area.fov_y) / 2);
  return {direction * (z / direction.z), direction};
}

Ray cast_ray(const AreaCaster& caster, Random random) {
  const AreaRays& options = caster.options;
  // Every ray draws all its numbers, in this order, so that an option changes nothing but what it is about.
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), drawn_depth = random.uniform();
  const double depth = options.start == RayStart::kNear ? 0 : drawn_depth;
  const auto* plane = std::get_if<PlaneArea>(&options.area.shape);
  LocalRay local = plane ? local_ray(*plane, x, y, depth)
                         : local_ray(std::get<PointArea>(options.area.shape), caster.geometry.window_half(),
                                     options.spread, {x, y, depth});
  const Frame& frame = caster.geometry.frame();
  Vec3d direction = plane ? frame.forward : normalized(to_world_direction(frame, local.direction));
  if (options.cone_degrees > 0) direction = random_in_cap(random, direction, caster.cone_cosine);
  if (options.jitter_radius > 0) local.origin = local.origin + random_in_disc(random, options.jitter_radius);
  return {to_float(to_world(frame, local.origin)), to_float(direction)};
}

}  // namespace

Vec3d angular_direction(double yaw, double pitch) {
  const SineCosine y = sine_cosine(yaw), p = sine_cosine(pitch);
  return {y.sine * p.cosine, -p.sine, y.cosine * p.cosine};
}

std::vector<Ray> cast_rays(const AreaRays& options, size_t count, uint64_t seed) {
  check_options(options);
  const AreaCaster caster(options);
  std::vector<Ray> rays(count);
  for (size_t i = 0; i < count; ++i) rays[i] = cast_ray(caster, ray_random(seed, i));
  return rays;
}

}  // namespace raygrain
