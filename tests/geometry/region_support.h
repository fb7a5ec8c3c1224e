// Random regions of every kind for the property tests, and an overlap test by clipping to compare with.
#pragma once

#include <cmath>
#include <vector>

#include "raygrain/region.h"

#include "base/random.h"
#include "base/trigonometry.h"

namespace raygrain::test {

inline Vec3d random_vector(Random& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

/// Kinds in turn: box, oriented box, frustum; sizes 1e-3 ... 1e3 of `scale`; every third far from the origin.
inline ConvexRegion random_region(uint64_t seed, double scale = 1) {
  Random random(seed * 977);
  const double offset = seed % 3 == 0 ? 100 : 1;
  const Vec3d origin = random_vector(random) * (offset * scale);
  const auto size = [&] { return scale * std::pow(10.0, random.uniform(-2, 1)); };
  const Frame frame = make_frame(origin, random_vector(random), random_vector(random));
  switch (random.below(3)) {
    case 0: {
      Bounds box;
      box.extend(to_float(origin));
      box.extend(to_float(origin + Vec3d{size(), size(), size()}));
      return box_region(box);
    }
    case 1:
      return oriented_box_region(frame, size(), size(), size());
    default: {
      const double near_z = size();
      const auto tan_half = [&] { return tangent(radians(random.uniform(1, 179) / 2)); };
      const double tan_x = tan_half(), tan_y = tan_half();
      return frustum_region(frame, tan_x, tan_y, near_z, near_z + size());
    }
  }
}

inline double diameter(const ConvexRegion& region) {
  double result = 0;
  for (const Vec3d a : region.corners)
    for (const Vec3d b : region.corners) result = std::fmax(result, length(a - b));
  return result;
}

/// A convex combination of the corners.
inline Vec3d point_inside(const ConvexRegion& region, Random& random) {
  Vec3d sum;
  double weights = 0;
  for (const Vec3d corner : region.corners) {
    const double weight = std::pow(random.uniform(), 3);
    sum = sum + corner * weight;
    weights += weight;
  }
  return sum / weights;
}

/// Does some point of the convex polygon keep to all planes moved out by `margin`? By clipping (Sutherland, Hodgman).
inline bool clipped_overlap(const ConvexRegion& region, std::vector<Vec3d> polygon, double margin) {
  for (const Plane& plane : region.planes) {
    std::vector<Vec3d> kept;
    for (size_t i = 0; i < polygon.size(); ++i) {
      const Vec3d p = polygon[i], q = polygon[(i + 1) % polygon.size()];
      const double hp = dot(plane.normal, p) - plane.offset - margin, hq = dot(plane.normal, q) - plane.offset - margin;
      if (hp <= 0) kept.push_back(p);
      if ((hp < 0) != (hq < 0) && hp != hq) kept.push_back(p + (q - p) * (hp / (hp - hq)));
    }
    polygon = kept;
  }
  return !polygon.empty();
}

}  // namespace raygrain::test
