// Where rays enter and leave a region, rounded inward; the proof is in docs/theory-areas.md.
#include <cmath>

#include "raygrain/region.h"

namespace raygrain {

namespace {

struct RealInterval {
  double enter = -std::numeric_limits<double>::infinity(), exit = std::numeric_limits<double>::infinity();
};

constexpr RealInterval kNothing{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

double one_norm(Vec3d v) {
  return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z);
}

// The rounding that the half slack left free must pay for: of double arithmetic along the ray, and of t itself where
// it is a denormal float (elsewhere one more step of t pays).
bool is_rounding_small(const ConvexRegion& region, Vec3d origin, Vec3d direction) {
  const double reach = one_norm(origin) + 0x1p26 * region.slack;
  return 0x1p-48 * reach <= region.slack / 4 && 0x1p-149 * one_norm(direction) <= region.slack / 4;
}

// The slab test against six planes moved out by the slack.
RealInterval cut(const ConvexRegion& region, Vec3d origin, Vec3d direction) {
  RealInterval result;
  for (const Plane& plane : region.planes) {
    const double speed = dot(plane.normal, direction);
    const double gap = plane.offset + region.slack - dot(plane.normal, origin);
    if (speed > 0)
      result.exit = std::fmin(result.exit, gap / speed);
    else if (speed < 0)
      result.enter = std::fmax(result.enter, gap / speed);
    else if (gap < 0)
      return kNothing;
  }
  return result;
}

// The largest float below which every float is the rounding of a number that is at most `value`.
float round_below(double value) {
  constexpr float kMax = std::numeric_limits<float>::max();
  if (value > kMax) return std::nextafter(kMax, 0.0f);
  if (value < -kMax) return -kInf;
  const float rounded = static_cast<float>(value);
  return std::nextafter(rounded > value ? std::nextafter(rounded, -kInf) : rounded, -kInf);
}

}  // namespace

float exit_distance(const ConvexRegion& region, const Ray& ray) {
  const Vec3d origin = to_double(ray.origin), direction = to_double(ray.direction);
  if (!is_valid(ray) || !contains(region, ray.origin) || !is_rounding_small(region, origin, direction)) return -kInf;
  const float exit = round_below(cut(region, origin, direction).exit);
  return exit >= 0 ? exit : -kInf;
}

RayInterval inside_interval(const ConvexRegion& region, const Ray& ray) {
  const Vec3d origin = to_double(ray.origin), direction = to_double(ray.direction);
  if (!is_valid(ray) || !is_rounding_small(region, origin, direction)) return {};
  const RealInterval interval = cut(region, origin, direction);
  const RayInterval result{-round_below(-interval.enter), round_below(interval.exit)};
  return result.enter <= result.exit ? result : RayInterval{};
}

}  // namespace raygrain
