#include "ray_sets.h"

#include <algorithm>
#include <cmath>

#include "raygrain/rays.h"

#include "base/random.h"

namespace raygrain::bench {
namespace {

void shuffle(std::vector<Ray>& rays, uint64_t seed) {
  Random random(seed);
  for (size_t i = rays.size(); i > 1; --i) std::swap(rays[i - 1], rays[random.below(i)]);
}

/// From above a corner of the scene towards its middle.
std::vector<Ray> camera_rays(const Bounds& box, size_t count) {
  const Vec3 size = extent(box), middle = center(box);
  CameraRays camera;
  camera.eye = {box.lo.x + 0.15f * size.x, box.lo.y + 0.55f * size.y, box.lo.z + 0.2f * size.z};
  camera.target = {middle.x, box.lo.y + 0.3f * size.y, middle.z};
  camera.height = static_cast<uint32_t>(std::sqrt(static_cast<double>(count) * 9 / 16));
  camera.width = camera.height * 16 / 9;
  return cast_rays(camera);
}

Vec3d unit_sphere_point(Random& random) {
  while (true) {
    const Vec3d p{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    const double square = dot(p, p);
    if (square > 1e-4 && square <= 1) return p / std::sqrt(square);
  }
}

/// Cosine-distributed about the normal, on the side that the camera sees, a little off the surface.
std::vector<Ray> bounces(const TriangleMesh& mesh, const WideBvh& tree, const std::vector<Ray>& camera, float length) {
  Random random(7);
  const float offset = 1e-4f * static_cast<float>(raygrain::length(to_double(extent(mesh_bounds(mesh)))));
  std::vector<Ray> rays;
  while (rays.size() < camera.size()) {
    const size_t before = rays.size();
    for (const Ray& ray : camera) {
      if (rays.size() == camera.size()) break;
      const Hit hit = tree.intersect(ray);
      if (!is_hit(hit)) continue;
      const Vec3d a = to_double(mesh.vertex(hit.triangle, 0));
      Vec3d normal = cross(to_double(mesh.vertex(hit.triangle, 1)) - a, to_double(mesh.vertex(hit.triangle, 2)) - a);
      normal = normalized(normal);
      if (dot(normal, to_double(ray.direction)) > 0) normal = -normal;
      const Vec3d direction = normal + unit_sphere_point(random) * 0.999;
      const Vec3d origin = to_double(ray.origin) + to_double(ray.direction) * static_cast<double>(hit.t) +
                           normal * static_cast<double>(offset);
      rays.push_back({to_float(origin), to_float(normalized(direction)), 0, length});
    }
    if (rays.size() == before) break;  // the camera sees nothing
  }
  shuffle(rays, 9);
  return rays;
}

std::vector<Ray> segments(const Bounds& box, size_t count) {
  Random random(11);
  const auto point = [&] {
    const Vec3d lo = to_double(box.lo), size = to_double(extent(box));
    const double x = random.uniform(), y = random.uniform();
    return lo + Vec3d{x * size.x, y * size.y, random.uniform() * size.z};
  };
  std::vector<Ray> rays;
  for (size_t i = 0; i < count; ++i) {
    const Vec3d from = point();
    rays.push_back({to_float(from), to_float(point() - from), 0, 1});
  }
  return rays;
}

}  // namespace

std::vector<BenchRays> general_ray_sets(const TriangleMesh& mesh, const WideBvh& tree, size_t count) {
  const Bounds box = mesh_bounds(mesh);
  const std::vector<Ray> camera = camera_rays(box, count);
  std::vector<Ray> shuffled = camera;
  shuffle(shuffled, 5);
  const float shortly = 0.03f * raygrain::length(extent(box));
  const std::vector<Ray> random_segments = segments(box, count);
  return {{"camera", false, camera},
          {"camera_shuffled", false, shuffled},
          {"diffuse", false, bounces(mesh, tree, camera, kInf)},
          {"ao", true, bounces(mesh, tree, camera, shortly)},
          {"segments", false, random_segments},
          {"segments", true, random_segments}};
}

}  // namespace raygrain::bench
