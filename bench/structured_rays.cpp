#include "structured_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "raygrain/rays.h"

#include "base/parallel.h"
#include "base/random.h"

namespace raygrain::bench {
namespace {

constexpr Vec3 kSun{-0.42f, -0.85f, 0.31f};  // the way its light goes

template <class T>
void shuffle(std::vector<T>& values, uint64_t seed) {
  Random random(seed);
  for (size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[random.below(i)]);
}

float tolerance_of(double degrees) {
  return static_cast<float>(1.0001 * (1 - std::cos(degrees * std::numbers::pi / 180)));
}

StructuredRays sharing_direction(const std::string& name, bool any, std::vector<Ray> rays, InfluenceArea area) {
  StructuredRays s{{name, any, std::move(rays)}, Sharing::kDirection, {}, {}, {std::move(area)}, "sun"};
  if (!s.set.rays.empty()) s.common = s.set.rays[0].direction;
  for (const Ray& ray : s.set.rays) s.points.push_back(ray.origin);
  return s;
}

StructuredRays sun_scan(const TriangleMesh& mesh, size_t count, bool shuffled) {
  InfluenceArea area = directional_light_area("sun", kSun, mesh_bounds(mesh));
  const auto across = static_cast<uint32_t>(std::sqrt(static_cast<double>(count)));
  std::vector<Ray> rays = window_grid_rays(area, across, across);
  if (shuffled) shuffle(rays, 5);
  return sharing_direction(shuffled ? "sun_closest_shuffled" : "sun_closest_scan", false, std::move(rays), area);
}

StructuredRays pinhole(const TriangleMesh& mesh, size_t count, bool shuffled) {
  const Bounds box = mesh_bounds(mesh);
  const Vec3 size = extent(box), middle = center(box);
  CameraRays camera;
  camera.eye = {box.lo.x + 0.15f * size.x, box.lo.y + 0.55f * size.y, box.lo.z + 0.2f * size.z};
  camera.target = {middle.x, box.lo.y + 0.3f * size.y, middle.z};
  camera.height = static_cast<uint32_t>(std::sqrt(static_cast<double>(count) * 9 / 16));
  camera.width = camera.height * 16 / 9;
  std::vector<Ray> rays = cast_rays(camera);
  if (shuffled) shuffle(rays, 5);
  const float aspect = static_cast<float>(camera.width) / static_cast<float>(camera.height);
  StructuredRays s{{shuffled ? "pinhole_closest_shuffled" : "pinhole_closest_scan", false, std::move(rays)},
                   Sharing::kStart,
                   camera.eye,
                   {},
                   {camera_area("camera", camera.eye, camera.target, camera.fov_y, aspect, box)},
                   "camera"};
  for (const Ray& ray : s.set.rays) s.points.push_back(ray.direction);
  return s;
}

Vec3 lamp_place(const Bounds& box) {
  const Vec3 size = extent(box), middle = center(box);
  return {middle.x + 0.11f * size.x, box.lo.y + 0.9f * size.y, middle.z - 0.07f * size.z};
}

StructuredRays lamp(const TriangleMesh& mesh, size_t count) {
  const Bounds box = mesh_bounds(mesh);
  const Vec3 place = lamp_place(box);
  StructuredRays s{{"point_any", true, cast_rays(SurfaceRays{TowardsPoint{place}}, mesh, count, 4)},
                   Sharing::kEnd,
                   place,
                   {},
                   point_light_areas("lamp", place, box),
                   "lamp"};
  for (const Ray& ray : s.set.rays) s.points.push_back(ray.origin);
  return s;
}

/// Directions uniform in a cap around the sun's.
StructuredRays disc(const TriangleMesh& mesh, size_t count, double degrees, const std::string& name) {
  InfluenceArea area = directional_light_area("disc", kSun, mesh_bounds(mesh));
  area.tolerance = tolerance_of(degrees);
  StructuredRays s{{name, true, cast_rays(SurfaceRays{TowardsDirection{kSun}}, mesh, count, 3)},
                   Sharing::kNothing,
                   {},
                   {},
                   {area},
                   "sun"};
  Random random(13);
  const Vec3d axis = normalized(-to_double(kSun)), right = normalized(cross(axis, Vec3d{1, 0, 0}));
  const Vec3d up = cross(axis, right);
  const double radius = std::tan(degrees * std::numbers::pi / 180);
  for (Ray& ray : s.set.rays) {
    double u = 1, v = 1;
    while (u * u + v * v > 1) u = random.uniform(-1, 1), v = random.uniform(-1, 1);
    ray.direction = to_float(normalized(axis + right * (u * radius) + up * (v * radius)));
  }
  return s;
}

StructuredRays rectangle(const TriangleMesh& mesh, size_t count) {
  const Bounds box = mesh_bounds(mesh);
  const Vec3 place = lamp_place(box), size = extent(box);
  const TowardsRectangle light{place, {0.02f * size.x, 0, 0}, {0, 0, 0.02f * size.z}};
  StructuredRays s{{"rect_any", true, cast_rays(SurfaceRays{light}, mesh, count, 6)},
                   Sharing::kNothing,
                   {},
                   {},
                   point_light_areas("rectangle", place, box),
                   "lamp"};
  for (InfluenceArea& area : s.areas) area.tolerance = tolerance_of(8);
  return s;
}

/// Between random points of the scene's box: nobody's rays.
StructuredRays foreign(const TriangleMesh& mesh, size_t count, bool any) {
  const Bounds box = mesh_bounds(mesh);
  Random random(11);
  const auto point = [&] {
    const Vec3d lo = to_double(box.lo), size = to_double(extent(box));
    const double x = random.uniform(), y = random.uniform();
    return lo + Vec3d{x * size.x, y * size.y, random.uniform() * size.z};
  };
  StructuredRays s;
  s.set = {any ? "foreign_any" : "foreign_closest", any, {}};
  for (size_t i = 0; i < count; ++i) {
    const Vec3d from = point();
    s.set.rays.push_back({to_float(from), to_float(point() - from), 0, 1});
  }
  s.areas = {directional_light_area("sun", kSun, box)};
  s.structure = "sun";
  return s;
}

}  // namespace

StructuredRays sun_rays(const TriangleMesh& mesh, Vec3 light, size_t count) {
  return sharing_direction("sun_any", true, cast_rays(SurfaceRays{TowardsDirection{light}}, mesh, count, 3),
                           directional_light_area("sun", light, mesh_bounds(mesh)));
}

std::vector<StructuredRays> structured_ray_sets(const TriangleMesh& mesh, size_t count) {
  return {sun_rays(mesh, kSun, count),
          sun_scan(mesh, count, false),
          sun_scan(mesh, count, true),
          lamp(mesh, count),
          pinhole(mesh, count, false),
          pinhole(mesh, count, true),
          disc(mesh, count, 0.27, "disc_any_0.27"),
          disc(mesh, count, 5, "disc_any_5"),
          rectangle(mesh, count),
          foreign(mesh, count, true),
          foreign(mesh, count, false)};
}

void trace_batch(const Accelerator& accelerator, const StructuredRays& rays, Answers& answers, unsigned threads) {
  switch (rays.sharing) {
    case Sharing::kDirection:
      if (rays.set.any) return accelerator.occluded(rays.points, rays.common, answers.flags, threads);
      return accelerator.intersect(rays.points, rays.common, answers.hits, threads);
    case Sharing::kEnd:
      return accelerator.occluded_towards(rays.points, rays.common, answers.flags, threads);
    case Sharing::kStart:
      return accelerator.intersect_from(rays.common, rays.points, answers.hits, threads);
    case Sharing::kNothing:
      return trace_array(accelerator, rays, answers, threads);
  }
}

void trace_array(const Accelerator& accelerator, const StructuredRays& rays, Answers& answers, unsigned threads) {
  if (rays.set.any)
    accelerator.occluded(rays.set.rays, answers.flags, threads);
  else
    accelerator.intersect(rays.set.rays, answers.hits, threads);
}

void trace_singly(const Accelerator& accelerator, const StructuredRays& rays, Answers& answers, unsigned threads) {
  parallel_for(rays.set.rays.size(), kRaysPerTask, threads, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      if (rays.set.any)
        answers.flags[i] = accelerator.occluded(rays.set.rays[i]) ? 1 : 0;
      else
        answers.hits[i] = accelerator.intersect(rays.set.rays[i]);
    }
  });
}

}  // namespace raygrain::bench
