// Influence areas for the light or camera a user has.
#include <cmath>
#include <limits>

#include "raygrain/area.h"
#include "raygrain/error.h"

#include "base/trigonometry.h"

namespace raygrain {

namespace {

constexpr double kMargin = 1.001;

void check_scene(const std::string& name, const Bounds& scene) {
  if (is_empty(scene) || !is_finite(scene.lo) || !is_finite(scene.hi))
    throw Error(ErrorCode::kBadArea, name, "the scene's box is empty or not finite", "load a mesh with triangles");
}

// Infinity where a float cannot hold it: `validate` refuses that with the field's name.
float narrow(double value) {
  return value > static_cast<double>(std::numeric_limits<float>::max()) ? kInf : static_cast<float>(value);
}

double farthest_corner(Vec3 from, const Bounds& scene) {
  double farthest = 0;
  for (int i = 0; i < 8; ++i) farthest = std::fmax(farthest, length(to_double(corner(scene, i)) - to_double(from)));
  return farthest > 0 ? farthest : 1;
}

PointArea point_area(Vec3 eye, Vec3 forward, Vec3 up, const Bounds& scene) {
  PointArea area;
  area.eye = eye;
  area.forward = forward;
  area.up = up;
  const double farthest = farthest_corner(eye, scene);
  area.near_z = narrow(1e-3 * farthest);
  area.far_z = narrow(kMargin * farthest);
  return area;
}

}  // namespace

InfluenceArea directional_light_area(const std::string& name, Vec3 direction, const Bounds& scene) {
  check_scene(name, scene);
  PlaneArea plane;
  plane.direction = direction;
  validate({name, plane}, name);
  const Frame frame = make_frame({}, to_double(direction), to_double(plane.up));
  Vec3d lo{1e300, 1e300, 1e300}, hi{-1e300, -1e300, -1e300};
  double scale = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3d p = to_local(frame, to_double(corner(scene, i)));
    lo = component_min(lo, p);
    hi = component_max(hi, p);
    scale = std::fmax(scale, length(p));
  }
  // The second term keeps flat scenes from having no window, and pays for rounding the area to float.
  const double extra = scale > 0 ? 0x1p-19 * scale : 1;
  const Vec3d half = (hi - lo) * (0.5 * kMargin) + Vec3d{1, 1, 1} * extra;
  const Vec3d middle = (hi + lo) * 0.5;
  plane.center = to_float(to_world(frame, {middle.x, middle.y, middle.z - half.z}));
  plane.half_width = narrow(half.x);
  plane.half_height = narrow(half.y);
  plane.depth = narrow(2 * half.z);
  InfluenceArea area{name, plane};
  validate(area, name);
  return area;
}

std::vector<InfluenceArea> point_light_areas(const std::string& name, Vec3 position, const Bounds& scene) {
  check_scene(name, scene);
  std::vector<InfluenceArea> areas;
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {1.0f, -1.0f}) {
      Vec3 forward, up;
      forward[axis] = sign;
      up[axis == 1 ? 2 : 1] = 1;
      areas.push_back({name + (sign > 0 ? "+" : "-") + "xyz"[axis], point_area(position, forward, up, scene)});
      validate(areas.back(), name);
    }
  return areas;
}

InfluenceArea camera_area(const std::string& name, Vec3 eye, Vec3 target, float fov_y, float aspect,
                          const Bounds& scene) {
  check_scene(name, scene);
  if (!(aspect > 0 && aspect < kInf))
    throw Error(ErrorCode::kBadArea, name, "aspect is " + std::to_string(aspect), "aspect must be positive and finite");
  const Vec3d view = to_double(target) - to_double(eye);
  const Vec3 forward = view == Vec3d{} ? Vec3{} : to_float(normalized(view));
  PointArea camera = point_area(eye, forward, {0, 1, 0}, scene);
  camera.fov_y = fov_y;
  validate({name, camera}, name);  // before the tangent of half of it
  const double tan_y = tangent(radians(static_cast<double>(fov_y) / 2));
  camera.fov_x = static_cast<float>(2 * arctangent(static_cast<double>(aspect) * tan_y, 1) * (180 / kPi));
  InfluenceArea area{name, camera};
  validate(area, name);
  return area;
}

}  // namespace raygrain
