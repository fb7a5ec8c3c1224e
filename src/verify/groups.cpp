// Which rays share something.
#include <algorithm>
#include <bit>

#include "verify/round.h"

namespace raygrain::verification {
namespace {

bool same(Vec3 a, Vec3 b) {
  for (int k = 0; k < 3; ++k)
    if (std::bit_cast<uint32_t>(a[k]) != std::bit_cast<uint32_t>(b[k])) return false;
  return true;
}

template <class Test>
bool all(const std::vector<Ray>& rays, const Test& test) {
  return !rays.empty() && std::ranges::all_of(rays, test);
}

}  // namespace

std::vector<RayGroup> groups_of(const std::vector<Ray>& rays, const std::vector<InfluenceArea>& areas) {
  std::vector<RayGroup> groups{{RayGroupKind::kMixed, {}, rays}};
  const auto is_endless = [](const Ray& ray) { return ray.tmin == 0 && ray.tmax == kInf; };
  if (all(rays, [&](const Ray& ray) { return is_endless(ray) && same(ray.direction, rays[0].direction); }))
    groups.push_back({RayGroupKind::kDirection, rays[0].direction, rays});
  if (all(rays, [&](const Ray& ray) { return is_endless(ray) && same(ray.origin, rays[0].origin); }))
    groups.push_back({RayGroupKind::kFrom, rays[0].origin, rays});
  for (const InfluenceArea& area : areas) {
    const auto* point = std::get_if<PointArea>(&area.shape);
    if (point != nullptr && all(rays, [&](const Ray& ray) {
          return ray.tmin == 0 && ray.tmax == 1 && same(ray.direction, point->eye - ray.origin);
        }))
      groups.push_back({RayGroupKind::kTowards, point->eye, rays});
  }
  return groups;
}

}  // namespace raygrain::verification
