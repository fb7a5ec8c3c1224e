// Rays and hits: the question and the answer of every search.
#pragma once

#include <cstdint>

#include "raygrain/vec.h"

namespace raygrain {

inline constexpr uint32_t kNoTriangle = 0xffffffffu;

/// The points origin + t * direction with tmin <= t <= tmax. `direction` need not have unit length; t counts in its
/// length. `tmax` may be infinite.
struct Ray {
  Vec3 origin, direction;
  float tmin = 0, tmax = kInf;
};

/// The answer to a ray: `triangle` is the caller's index, or kNoTriangle with t = infinity for a miss.
/// `u` and `v` are the barycentric weights of the triangle's second and third vertex, in [0, 1].
struct Hit {
  float t = kInf, u = 0, v = 0;
  uint32_t triangle = kNoTriangle;

  friend constexpr bool operator==(const Hit&, const Hit&) = default;
};

constexpr bool is_hit(const Hit& hit) {
  return hit.triangle != kNoTriangle;
}

/// The order that decides the nearest hit: least t, ties to the lower triangle index. A miss comes last.
constexpr bool is_nearer(const Hit& a, const Hit& b) {
  return a.t < b.t || (a.t == b.t && a.triangle < b.triangle);
}

/// False for rays that are a miss by definition: NaN anywhere, infinite origin or direction, zero direction.
inline bool is_valid(const Ray& ray) {
  return is_finite(ray.origin) && is_finite(ray.direction) && ray.direction != Vec3{} && !std::isnan(ray.tmin) &&
         !std::isnan(ray.tmax);
}

}  // namespace raygrain
