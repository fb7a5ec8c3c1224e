#include <algorithm>
#include <cmath>

#include "raygrain/error.h"
#include "raygrain/rays.h"

#include "rays/ray_random.h"

namespace raygrain {
namespace {

constexpr double kOffset = 1e-4;  // of the scene's diagonal

// sums[i] is the area of triangles 0 ... i, times 2.
std::vector<double> cumulative_areas(const TriangleMesh& mesh) {
  std::vector<double> sums(mesh.triangle_count());
  double sum = 0;
  for (size_t i = 0; i < sums.size(); ++i) {
    const Vec3d a = to_double(mesh.vertex(i, 0));
    sum += length(cross(to_double(mesh.vertex(i, 1)) - a, to_double(mesh.vertex(i, 2)) - a));
    sums[i] = sum;
  }
  return sums;
}

struct SurfacePoint {
  Vec3d position, normal;  // either side's unit normal
};

// A triangle by its share of the area; never one without area.
size_t random_triangle(const std::vector<double>& sums, Random& random) {
  auto found = std::upper_bound(sums.begin(), sums.end(), random.uniform() * sums.back());
  if (found == sums.end()) found = std::lower_bound(sums.begin(), sums.end(), sums.back());  // the product rounded up
  return static_cast<size_t>(found - sums.begin());
}

SurfacePoint random_surface_point(const TriangleMesh& mesh, const std::vector<double>& sums, Random& random) {
  const size_t triangle = random_triangle(sums, random);
  const Vec3d a = to_double(mesh.vertex(triangle, 0));
  const Vec3d to_b = to_double(mesh.vertex(triangle, 1)) - a, to_c = to_double(mesh.vertex(triangle, 2)) - a;
  // Uniform on a triangle: Osada et al., "Shape distributions", 2002.
  const double root = std::sqrt(random.uniform()), share = random.uniform();
  return {a + to_b * (root * (1 - share)) + to_c * (root * share), normalized(cross(to_b, to_c))};
}

Vec3 lift_off(const SurfacePoint& point, Vec3d to_target, double offset) {
  const double side = dot(point.normal, to_target) < 0 ? -offset : offset;
  return to_float(point.position + point.normal * side);
}

Ray ray_to_point(const SurfacePoint& from, Vec3 target, double offset) {
  const Vec3 origin = lift_off(from, to_double(target) - from.position, offset);
  return {origin, target - origin, 0, 1};
}

Ray cast_towards(const TowardsDirection& light, const SurfacePoint& from, double offset, Random&) {
  const Vec3d to_light = -normalized(to_double(light.direction));
  return {lift_off(from, to_light, offset), to_float(to_light)};
}
Ray cast_towards(const TowardsPoint& light, const SurfacePoint& from, double offset, Random&) {
  return ray_to_point(from, light.point, offset);
}
Ray cast_towards(const TowardsRectangle& light, const SurfacePoint& from, double offset, Random& random) {
  const double u = random.uniform(-1, 1), v = random.uniform(-1, 1);
  const Vec3d target = to_double(light.center) + to_double(light.half_u) * u + to_double(light.half_v) * v;
  return ray_to_point(from, to_float(target), offset);
}

[[noreturn]] void refuse(const char* message, const char* hint = "") {
  throw Error(ErrorCode::kUsage, "surface rays", message, hint);
}

void check_target(const TowardsDirection& light) {
  if (!is_finite(light.direction)) refuse("the direction is not finite");
  if (light.direction == Vec3{}) refuse("the direction is zero", "Give the direction in which the light travels");
}
void check_target(const TowardsPoint& light) {
  if (!is_finite(light.point)) refuse("the point is not finite");
}
void check_target(const TowardsRectangle& light) {
  if (!is_finite(light.center) || !is_finite(light.half_u) || !is_finite(light.half_v))
    refuse("the rectangle is not finite");
}

}  // namespace

std::vector<Ray> cast_rays(const SurfaceRays& options, const TriangleMesh& mesh, size_t count, uint64_t seed) {
  std::visit([](const auto& target) { check_target(target); }, options.target);
  const std::vector<double> sums = cumulative_areas(mesh);
  if (sums.empty() || !(sums.back() > 0)) return {};
  const Bounds box = mesh_bounds(mesh);
  const double offset = kOffset * length(to_double(box.hi) - to_double(box.lo));
  std::vector<Ray> rays(count);
  for (size_t i = 0; i < count; ++i) {
    Random random = ray_random(seed, i);
    const SurfacePoint point = random_surface_point(mesh, sums, random);
    rays[i] =
        std::visit([&](const auto& target) { return cast_towards(target, point, offset, random); }, options.target);
  }
  return rays;
}

}  // namespace raygrain
