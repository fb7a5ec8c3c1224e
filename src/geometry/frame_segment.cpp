// Rays in ray space. u = 2^-53; S = frame.norm; V, L = largest components of origin - center and of the direction. The
// bounds are derived in docs/theory-frames.md, section "Rays".
#include <algorithm>
#include <cmath>

#include "raygrain/ray_frame.h"

#include "geometry/frame_polygon.h"
#include "geometry/rounding.h"

namespace raygrain {
namespace {

constexpr double kRoundoff = 0x1p-53;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The ray in local coordinates, with the sizes that errors are measured in.
struct LocalRay {
  Vec3d origin, direction;
  double origin_size, direction_size;  // S V, S L

  /// z of the point at t, and a bound of its error.
  double depth(double t, double& error) const {
    if (std::isinf(t)) {
      error = 0;
      return (t > 0) == (direction.z > 0) ? kInfinity : -kInfinity;
    }
    error = 8 * kRoundoff * (origin_size + std::abs(t) * direction_size);
    return origin.z + t * direction.z;
  }
};

struct Depths {
  double lo, hi, sure_lo, sure_hi;
};

Depths depths_of(const LocalRay& local, const Ray& ray) {
  const bool ascending = local.direction.z > 0;
  // A t that rounds to a float in [tmin, tmax] lies in [earliest, latest].
  constexpr double kMost = std::numeric_limits<float>::max(), kUlp = 0x1p-23, kLeast = 0x1p-149;
  const double tmin = ray.tmin, tmax = ray.tmax;
  const double earliest = std::min(tmin, kMost) - (std::min(std::abs(tmin), kMost) * kUlp + kLeast);
  const double latest = std::max(tmax, -kMost) + (std::min(std::abs(tmax), kMost) * kUlp + kLeast);
  double error = 0;
  Depths depths{};
  depths.lo = local.depth(ascending ? earliest : latest, error);
  depths.lo -= error;
  depths.hi = local.depth(ascending ? latest : earliest, error);
  depths.hi += error;
  depths.sure_lo = local.depth(ascending ? tmin : tmax, error);
  depths.sure_lo += error;
  depths.sure_hi = local.depth(ascending ? tmax : tmin, error);
  depths.sure_hi -= error;
  return depths;
}

double inverted(double depth) {
  return depth == kInfinity ? 0 : -1 / depth;
}

/// As depths in a projective frame; false where all is before the near plane.
bool project(Depths& depths, double near_z) {
  if (depths.hi < near_z) return false;
  constexpr double kOut = 4 * kRoundoff;
  depths.lo = inverted(std::max(depths.lo, near_z)) * (1 + kOut);
  depths.hi = inverted(depths.hi) * (1 - kOut);
  depths.sure_lo = inverted(std::max(depths.sure_lo, near_z)) * (1 - kOut);
  depths.sure_hi = depths.sure_hi < near_z ? -kInfinity : inverted(depths.sure_hi) * (1 + kOut);
  return true;
}

void set_parallel(const LocalRay& local, double inverse, double steepness, FrameSegment& s) {
  const Vec3d& q = local.origin;
  const Vec3d& m = local.direction;
  s.slope_x = m.x * inverse;
  s.slope_y = m.y * inverse;
  s.x0 = q.x + (s.z0 - q.z) * s.slope_x;
  s.y0 = q.y + (s.z0 - q.z) * s.slope_y;
  const double lean = 1 + std::max(std::abs(s.slope_x), std::abs(s.slope_y));
  const double reach = std::abs(s.z0 - q.z) + (s.z_hi - s.z_lo);
  s.error = 16 * kRoundoff * lean * (local.origin_size + 2 * steepness * reach);
  s.slope_error = 16 * kRoundoff * lean * steepness;
  s.tie_constant = 0x1p-22 * std::abs(q.z) + 0x1p-148 * std::abs(m.z);
  s.tie_linear = 0x1p-22;
}

void set_projective(const LocalRay& local, double inverse, double steepness, FrameSegment& s) {
  const Vec3d& q = local.origin;
  const Vec3d& m = local.direction;
  const double x = m.x * inverse, y = m.y * inverse;
  s.slope_x = q.z * x - q.x;
  s.slope_y = q.z * y - q.y;
  s.x0 = x + s.z0 * s.slope_x;
  s.y0 = y + s.z0 * s.slope_y;
  const double lean = 1 + std::max(std::abs(x), std::abs(y)), depth = std::max(-s.z_lo, -s.z_hi);
  s.error = 32 * kRoundoff * steepness * lean * (1 + depth * local.origin_size);
  s.slope_error = 32 * kRoundoff * steepness * lean * local.origin_size;
  s.tie_linear = 0x1p-21;
  s.tie_square = 0x1p-21 * std::abs(q.z) + 0x1p-147 * std::abs(m.z);
}

}  // namespace

FrameFit make_segment(const RayFrame& frame, const Ray& ray, std::array<float, 2> z_range, FrameSegment& segment) {
  constexpr double kSteepest = 0x1p10, kFarthest = 0x1p18;
  const Vec3d offset = to_double(ray.origin) - frame.center, d = to_double(ray.direction);
  const auto turned = [&](Vec3d v) {
    return Vec3d{dot(frame.rows[0], v), dot(frame.rows[1], v), dot(frame.rows[2], v)};
  };
  const LocalRay local{turned(offset), turned(d), frame.norm * largest_component(offset),
                       frame.norm * largest_component(d)};
  const double inverse = 1 / local.direction.z, steepness = local.direction_size * std::abs(inverse);
  if (!(steepness <= kSteepest)) return FrameFit::kUnfit;
  if (frame.is_projective() && !(local.origin_size <= kFarthest * frame.near_z)) return FrameFit::kUnfit;

  Depths depths = depths_of(local, ray);
  if (frame.is_projective() && !project(depths, frame.near_z)) return FrameFit::kNothing;
  segment.ascending = local.direction.z > 0;
  segment.z_lo = std::max(depths.lo, static_cast<double>(z_range[0]));
  segment.z_hi = std::min(depths.hi, static_cast<double>(z_range[1]));
  if (!(segment.z_lo <= segment.z_hi)) return FrameFit::kNothing;
  segment.sure_lo = std::max(depths.sure_lo, segment.z_lo);
  segment.sure_hi = std::min(depths.sure_hi, segment.z_hi);
  segment.z0 = 0.5 * segment.z_lo + 0.5 * segment.z_hi;
  segment.tie_constant = segment.tie_linear = segment.tie_square = 0;
  frame.is_projective() ? set_projective(local, inverse, steepness, segment)
                        : set_parallel(local, inverse, steepness, segment);
  return FrameFit::kServed;
}

double drift(const FrameSegment& s) {
  return std::max(std::abs(s.slope_x), std::abs(s.slope_y)) * 0.5 * (s.z_hi - s.z_lo);
}

FrameColumn to_column(const FrameSegment& s) {
  constexpr double kOut = 0x1p-50;
  FrameColumn column;
  const double half = (0.5 + kOut) * (s.z_hi - s.z_lo);
  const double x_slack = std::abs(s.slope_x) * half + s.error, y_slack = std::abs(s.slope_y) * half + s.error;
  const double x_out = x_slack + kOut * (x_slack + std::abs(s.x0));
  const double y_out = y_slack + kOut * (y_slack + std::abs(s.y0));
  column.box = {{loosely_below(s.x0 - x_out), loosely_below(s.y0 - y_out), loosely_below(s.z_lo)},
                {loosely_above(s.x0 + x_out), loosely_above(s.y0 + y_out), loosely_above(s.z_hi)}};
  column.x = static_cast<float>(s.x0);
  column.y = static_cast<float>(s.y0);
  const Vec3d lo = to_double(column.box.lo), hi = to_double(column.box.hi);
  const double x = column.x, y = column.y;
  const double radius = std::max(std::max(hi.x - x, x - lo.x), std::max(hi.y - y, y - lo.y));
  column.radius = loosely_above(radius);
  column.sure_lo = loosely_above(s.sure_lo);
  column.sure_hi = loosely_below(s.sure_hi);
  column.ascending = s.ascending;
  return column;
}

}  // namespace raygrain
