// Random influence areas, boxes where projections fail, and an independent ray-box test.
#pragma once

#include <cmath>
#include <utility>

#include "raygrain/area.h"

#include "geometry/region_support.h"

namespace raygrain::test {

inline float random_size(Random& random, double lo_exponent, double hi_exponent) {
  return static_cast<float>(std::pow(10.0, random.uniform(lo_exponent, hi_exponent)));
}

inline PlaneArea random_plane_area(Random& random) {
  PlaneArea area;
  area.center = to_float(random_vector(random) * 3.0);
  area.direction = to_float(random_vector(random));
  if (random.below(4) == 0) {  // along a coordinate axis
    area.direction = {};
    area.direction[static_cast<int>(random.below(3))] = random.below(2) != 0 ? 1.0f : -2.0f;
  }
  area.up = to_float(random_vector(random));
  area.half_width = random_size(random, -0.5, 0.7);
  area.half_height = random_size(random, -0.5, 0.7);
  area.depth = random_size(random, -0.5, 1);
  return area;
}

inline PointArea random_point_area(Random& random) {
  PointArea area;
  area.eye = to_float(random_vector(random) * 3.0);
  area.forward = to_float(random_vector(random));
  if (random.below(4) == 0) {
    area.forward = {};
    area.forward[static_cast<int>(random.below(3))] = random.below(2) != 0 ? 1.0f : -2.0f;
  }
  area.up = to_float(random_vector(random));
  area.fov_x = static_cast<float>(random.uniform(10, 150));
  area.fov_y = static_cast<float>(random.uniform(10, 150));
  area.near_z = random_size(random, -2, 0);
  area.far_z = area.near_z + random_size(random, -0.5, 1);
  return area;
}

/// Makes a point area see nearly half of everything.
inline void widen(InfluenceArea& area, Random& random) {
  constexpr float kWide[] = {170, 179, 179.9f};
  if (auto* point = std::get_if<PointArea>(&area.shape)) {
    point->fov_x = kWide[random.below(std::size(kWide))];
    if (random.below(2)) point->fov_y = kWide[random.below(std::size(kWide))];
  }
}

inline InfluenceArea random_area(Random& random, bool plane) {
  if (plane) return {"random", random_plane_area(random)};
  return {"random", random_point_area(random)};
}

/// A box that is, in turn: anywhere about the region, around the eye, across the near face, across the far face, beyond
/// the far face, behind the near face, flat, or around everything.
inline Bounds random_box(const AreaGeometry& area, Random& random) {
  const ConvexRegion& region = area.region();
  const double whole = diameter(region), size = whole * std::pow(10.0, random.uniform(-1.2, 0));
  const auto mean_of = [&](size_t first, size_t second) {
    return (region.corners[first] + region.corners[second]) * 0.5;
  };
  const Vec3d near_middle = mean_of(0, 3), far_middle = mean_of(4, 7), forward = area.frame().forward;
  const uint64_t kind = random.below(8);
  Vec3d middle = point_inside(region, random) + random_vector(random) * (0.3 * size);
  if (kind == 1) middle = area.frame().origin + random_vector(random) * (0.5 * size);
  if (kind == 2) middle = near_middle + random_vector(random) * (0.5 * size);
  if (kind == 3) middle = far_middle + random_vector(random) * (0.5 * size);
  if (kind == 4) middle = far_middle + forward * (whole * random.uniform());
  if (kind == 5) middle = near_middle - forward * (whole * random.uniform());
  Vec3d half = Vec3d{random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1)} * size;
  if (kind == 6) half[static_cast<int>(random.below(3))] = 0;
  if (kind == 7) half = half * 20.0;
  return {to_float(middle - half), to_float(middle + half)};
}

/// Does the segment origin + t * direction, lo <= t <= hi, meet the closed box?
inline bool segment_meets(const Bounds& box, Vec3d origin, Vec3d direction, double lo, double hi) {
  for (int k = 0; k < 3; ++k) {
    const double low = static_cast<double>(box.lo[k]), high = static_cast<double>(box.hi[k]);
    if (direction[k] == 0) {
      if (origin[k] < low || origin[k] > high) return false;
      continue;
    }
    double enter = (low - origin[k]) / direction[k], leave = (high - origin[k]) / direction[k];
    if (enter > leave) std::swap(enter, leave);
    lo = std::fmax(lo, enter);
    hi = std::fmin(hi, leave);
  }
  return lo <= hi;
}

}  // namespace raygrain::test
