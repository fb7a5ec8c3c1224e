// Rays of an isotropic light.
#pragma once

#include <cmath>
#include <vector>

#include "raygrain/area.h"
#include "raygrain/ray.h"

#include "base/random.h"

namespace raygrain::test {

/// As many as a point area's window shows, all solid angles alike, from the near plane on; drawn in the whole sphere.
inline std::vector<Ray> isotropic_rays(const InfluenceArea& area, size_t count, uint64_t seed) {
  const AreaGeometry geometry(area);
  const Vec2d half = geometry.window_half();
  const double near = std::get<PointArea>(area.shape).near_z;
  Random random(seed);
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const Vec3d v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    if (dot(v, v) > 1 || v.z <= 0.01 || std::fabs(v.x) > half.x * v.z || std::fabs(v.y) > half.y * v.z) continue;
    const Vec3d start = to_world(geometry.frame(), v * (near / v.z));
    rays.push_back({to_float(start), to_float(normalized(to_world_direction(geometry.frame(), v)))});
  }
  return rays;
}

}  // namespace raygrain::test
