#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <utility>

#include "raygrain/families.h"
#include "raygrain/rays.h"

#include "base/random.h"

namespace raygrain {
namespace {

constexpr double kGreatest = 3e38;

float clamped(double x) {
  return static_cast<float>(std::clamp(x, -kGreatest, kGreatest));
}
Vec3 clamped(Vec3d p) {
  return {clamped(p.x), clamped(p.y), clamped(p.z)};
}
/// A size that is fit for an area: positive and finite.
float size(double x) {
  return static_cast<float>(std::clamp(x, 1e-44, kGreatest));
}

Vec3d random_vector(Random& random) {
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
  return {x, y, random.uniform(-1, 1)};
}

struct Ball {
  Vec3d center;
  double radius = 1;
};

Ball ball_of(const TriangleMesh& mesh) {
  const Bounds box = mesh_bounds(mesh);
  if (is_empty(box)) return {};
  const Vec3d lo = to_double(box.lo), hi = to_double(box.hi);
  const double radius = length(hi - lo) / 2;
  return {(lo + hi) / 2.0, radius > 0 ? radius : 1};
}

/// A point of a mesh where tracers fail: a vertex, on an edge, or in a face.
Vec3 target(const TriangleMesh& mesh, Random& random) {
  if (mesh.triangles.empty()) return clamped(random_vector(random));
  const size_t triangle = random.below(mesh.triangle_count());
  const Vec3 a = mesh.vertex(triangle, static_cast<int>(random.below(3)));
  const Vec3d b = to_double(mesh.vertex(triangle, static_cast<int>(random.below(3))));
  const Vec3d c = to_double(mesh.vertex(triangle, static_cast<int>(random.below(3))));
  const uint64_t kind = random.below(4);
  if (kind == 0) return a;
  const double weight = random.below(2) ? 0.5 : random.uniform();
  const Vec3d on_edge = to_double(a) * (1 - weight) + b * weight;
  const double depth = kind == 1 ? random.uniform() : 0;
  return clamped(on_edge * (1 - depth) + c * depth);
}

/// A point of a region, on its border half of the time.
Vec3 region_point(const ConvexRegion& region, Random& random) {
  Vec3d weights{random.uniform(), random.uniform(), random.uniform()};
  if (random.below(2)) {
    const int axis = static_cast<int>(random.below(3));
    weights[axis] = static_cast<double>(random.below(2));
    if (random.below(3) == 0) weights[(axis + 1) % 3] = static_cast<double>(random.below(2));
  }
  Vec3d point{};
  for (size_t i = 0; i < 8; ++i) {
    const double weight = ((i & 1) ? weights.x : 1 - weights.x) * ((i & 2) ? weights.y : 1 - weights.y) *
                          ((i & 4) ? weights.z : 1 - weights.z);
    point = point + region.corners[i] * weight;
  }
  return clamped(point);
}

/// A ray that an area serves, or nearly.
Ray ray_of_area(const AreaGeometry& area, const TriangleMesh& mesh, double radius, Random& random) {
  Vec3d origin = to_double(region_point(area.region(), random));
  Vec3d direction = area.ray_direction(origin);
  switch (random.below(4)) {
    case 0:
      break;
    case 1:
      direction = to_double(target(mesh, random)) - origin;
      break;
    case 2: {  // through a point of the mesh, along the area's rays there
      const Vec3d point = to_double(target(mesh, random));
      direction = area.ray_direction(point);
      const double one_norm = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
      origin = point - direction * (random.uniform(0, 2 * radius) / one_norm);
      break;
    }
    default: {
      const double one_norm = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
      direction = direction + random_vector(random) * (0.2 * one_norm);
      break;
    }
  }
  if (random.below(3) == 0) direction = -direction;
  return {clamped(origin), clamped(direction)};
}

void limit_some(Ray& ray, Random& random) {
  if (random.below(8) == 0) ray.tmax = static_cast<float>(random.uniform(0, 2));
  if (random.below(8) == 0) ray.tmin = static_cast<float>(random.uniform(-0.2, 1));
}

std::array<uint32_t, 8> bits(const Ray& ray) {
  const auto of = [](float x) { return std::bit_cast<uint32_t>(x); };
  return {of(ray.origin.x),    of(ray.origin.y),    of(ray.origin.z), of(ray.direction.x),
          of(ray.direction.y), of(ray.direction.z), of(ray.tmin),     of(ray.tmax)};
}

}  // namespace

std::vector<InfluenceArea> areas_around(const TriangleMesh& mesh, uint64_t seed) {
  Random random(seed);
  const auto [center, radius] = ball_of(mesh);
  const Vec3d oblique = random_vector(random), sideways = random_vector(random);
  const auto plane = [&, c = center, r = radius](const char* name, Vec3d offset, Vec3d direction, double half_width,
                                                 double half_height, double depth, float tolerance) {
    return InfluenceArea{name,
                         PlaneArea{clamped(c + offset * r), clamped(direction), clamped(random_vector(random)),
                                   size(half_width * r), size(half_height * r), size(depth * r)},
                         tolerance};
  };
  const auto point = [&, c = center, r = radius](const char* name, Vec3d offset, Vec3d forward, float fov_x,
                                                 float fov_y, double near_z, double far_z, float tolerance) {
    return InfluenceArea{name,
                         PointArea{clamped(c + offset * r), clamped(forward), clamped(random_vector(random)), fov_x,
                                   fov_y, size(near_z * r), size(far_z * r)},
                         tolerance};
  };
  constexpr std::array kWide{std::pair{120.0f, 140.0f}, std::pair{170.0f, 120.0f}, std::pair{179.0f, 170.0f},
                             std::pair{179.9f, 179.9f}};
  const auto [fov_x, fov_y] = kWide[seed % kWide.size()];
  return {
      plane("whole", {0, 0, -1}, {0, 0, 1}, 1, 1, 2, 0.01f),
      plane("first half", {0, 0.9, 0.1}, {0, -1, 0}, 0.4, 0.6, 0.9, 0.05f),
      plane("second half", {0, 0, 0.1}, {0, -3, 0}, 0.5, 0.5, 1, 0.5f),
      plane("oblique", oblique * -0.4, oblique, 0.3, 0.2, 0.7, 0.3f),
      point("lamp", sideways * 1.5, -sideways, 40, 50, 0.2, 3, 0.01f),
      point("inside", {0.1, -0.1, 0.05}, sideways, fov_x, fov_y, 0.01, 0.8, 0.4f),
      point("beside", {3, 0, 0}, {1, 0, 0}, 60, 60, 0.1, 1, 0.01f),
  };
}

std::vector<Ray> rays_of_areas(const TriangleMesh& mesh, const std::vector<InfluenceArea>& areas, size_t count,
                               uint64_t seed) {
  Random random(seed);
  std::vector<Ray> rays;
  const size_t per_area = (count + areas.size() - 1) / areas.size();
  for (const InfluenceArea& area : areas) {
    const AreaGeometry geometry(area);
    const AreaRays straight{area},
        spread{area, RayStart::kRandomDepth, PointSpread::kAngle, 5, size(0.01 * ball_of(mesh).radius)};
    for (const Ray& ray : cast_rays(straight, per_area / 4, random.next())) rays.push_back(ray);
    for (const Ray& ray : cast_rays(spread, per_area / 4, random.next())) rays.push_back(ray);
    for (size_t i = 0; i < per_area - 2 * (per_area / 4); ++i)
      rays.push_back(ray_of_area(geometry, mesh, ball_of(mesh).radius, random));
  }
  for (Ray& ray : rays) limit_some(ray, random);
  return rays;
}

std::vector<Ray> rays_from(Vec3 origin, const TriangleMesh& mesh, size_t count, uint64_t seed) {
  Random random(seed);
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const Ray ray{origin, clamped(to_double(target(mesh, random)) - to_double(origin))};
    if (is_valid(ray)) rays.push_back(ray);
  }
  return rays;
}

void keep_distinct(std::vector<Ray>& rays) {
  std::ranges::sort(rays, {}, bits);
  const auto equal = [](const Ray& a, const Ray& b) { return bits(a) == bits(b); };
  rays.erase(std::unique(rays.begin(), rays.end(), equal), rays.end());
}

}  // namespace raygrain
