// Rays prepared for trees in ray space. Nearly all of an area's rays take the short way: a column whose x and y hold
// the ray along the whole tree. docs/theory-frames.md, section "Columns", has the bounds.
#include <algorithm>
#include <cmath>

#include "geometry/rounding.h"
#include "trace/frame_memory.h"

namespace raygrain {
namespace {

/// Rays that leave their middle line by no more than this share of the tree's width are columns.
constexpr double kColumnDrift = 0x1p-14;
/// Rays that leave it by no more than this along the whole tree are cones.
constexpr double kConeDrift = 0.5;

constexpr double kLeastSlope = 0x1p-40;  // of the tree's width, over its depth

/// One coordinate of a cone: x = at + slope (z - z0), wrong by at most `error`.
struct ConeSide {
  float intercept, slope, inverse, near, far;
  double error;  // of intercept + slope z, evaluated in float
};

ConeSide cone_side(const FrameMemory& tree, const FrameSegment& s, double at, double slope, double error) {
  const double depth =
      std::max(std::abs(static_cast<double>(tree.depths[0])), std::abs(static_cast<double>(tree.depths[1])));
  const double whole = static_cast<double>(tree.depths[1]) - static_cast<double>(tree.depths[0]);
  const double steep = std::copysign(std::max(std::abs(slope), kLeastSlope * tree.width / whole), slope);
  ConeSide side{};
  side.inverse = static_cast<float>(1 / steep);
  const double inverse = side.inverse, used = 1 / inverse;
  error += (std::abs(used - slope) + s.slope_error) * whole;
  const double offset = s.z0 - at * inverse;
  const double slack = std::abs(inverse) * (error + 0x1p-22 * tree.width) + 0x1p-22 * depth;
  side.near = loosely_below(offset - slack);
  side.far = loosely_above(offset + slack);
  side.slope = static_cast<float>(used);
  side.intercept = static_cast<float>(at - used * s.z0);
  side.error = error + 0x1p-21 * (tree.reach + std::abs(used) * depth + std::abs(static_cast<double>(side.intercept)));
  return side;
}

void set_cone(const FrameMemory& tree, const FrameSegment& s, FrameQuery& query) {
  const ConeSide x = cone_side(tree, s, s.x0, s.slope_x, s.error), y = cone_side(tree, s, s.y0, s.slope_y, s.error);
  query.x0 = x.intercept;
  query.y0 = y.intercept;
  query.slope_x = x.slope;
  query.slope_y = y.slope;
  query.inverse_x = x.inverse;
  query.inverse_y = y.inverse;
  query.near_x = x.near;
  query.far_x = x.far;
  query.near_y = y.near;
  query.far_y = y.far;
  query.error = loosely_above(std::max(x.error, y.error));
}

Vec3d turned(const RayFrame& frame, Vec3d v) {
  return {dot(frame.rows[0], v), dot(frame.rows[1], v), dot(frame.rows[2], v)};
}
double largest(Vec3d v) {
  return std::max(std::max(std::abs(v.x), std::abs(v.y)), std::abs(v.z));
}

/// Local z from and to, in the order of z, outward and inward; errors as in make_segment.
struct Depths {
  double lo, hi, sure_lo, sure_hi;

  Depths(const Ray& ray, double at, double speed, double origin_size, double direction_size) {
    constexpr double kMost = std::numeric_limits<float>::max(), kUlp = 0x1p-23, kLeast = 0x1p-149, kError = 0x1p-50;
    const double tmin = ray.tmin, tmax = ray.tmax;
    const double first = std::abs(tmin) * kUlp + kLeast, last = std::min(std::abs(tmax), kMost) * kUlp + kLeast;
    const double first_error = kError * (origin_size + std::abs(tmin) * direction_size);
    const double last_error = kError * (origin_size + std::abs(tmax) * direction_size);
    const double pace = std::abs(speed), start = at + tmin * speed, end = at + tmax * speed;
    const double before = first_error + 2 * first * pace, after = last_error + 2 * last * pace;
    if (speed > 0) {
      lo = start - before;
      hi = end + after;
      sure_lo = start + first_error;
      sure_hi = end - last_error;  // NaN for an infinite tmax
    } else {
      lo = end - after;
      hi = start + before;
      sure_lo = end + last_error;
      sure_hi = start - first_error;
    }
  }
};

void set_sides(Column& column, double x, double y, double radius) {
  column.box.lo.x = loosely_below(x - radius);
  column.box.lo.y = loosely_below(y - radius);
  column.box.hi.x = loosely_above(x + radius);
  column.box.hi.y = loosely_above(y + radius);
  column.x = static_cast<float>(x);
  column.y = static_cast<float>(y);
  // The box is at most two roundings wider than the radius.
  const double size = std::max(std::abs(x), std::abs(y));
  column.radius = static_cast<float>((radius + size * 0x1p-22 + 0x1p-146) * (1 + 0x1p-18));
}

/// False where the way is not short: the ray may still be a column. Finite tmin.
bool set_column(const FrameMemory& tree, const Ray& ray, FrameQuery& query) {
  const RayFrame& frame = tree.frame;
  const Vec3d offset = to_double(ray.origin) - frame.center, direction = to_double(ray.direction);
  const Vec3d q = turned(frame, offset), m = turned(frame, direction);
  const double origin_size = frame.norm * largest(offset), direction_size = frame.norm * largest(direction);
  const double inverse = 1 / m.z, steepness = direction_size * std::abs(inverse);
  const double x = m.x * inverse, y = m.y * inverse;
  Depths depths(ray, q.z, m.z, origin_size, direction_size);
  double radius, at_x, at_y;
  if (frame.is_projective()) {
    const double slope_x = q.z * x - q.x, slope_y = q.z * y - q.y, lean = 1 + std::max(std::abs(x), std::abs(y));
    at_x = x + tree.middle * slope_x;
    at_y = y + tree.middle * slope_y;
    radius = std::max(std::abs(slope_x), std::abs(slope_y)) * tree.half +
             0x1p-48 * steepness * lean * (1 + tree.depth * origin_size);
    query.tie_constant = 0;
    query.tie_linear = 0x1p-20f;
    query.tie_square = loosely_above(0x1p-20 * std::abs(q.z) + 0x1p-147 * std::abs(m.z));
    const double near_z = frame.near_z;
    if (!(origin_size <= 0x1p18 * near_z)) return false;
    if (depths.hi < near_z) return true;  // the box is empty
    const double lo = std::max(depths.lo, near_z), inverse_lo = 1 / lo, inverse_hi = 1 / depths.hi;
    const double more = depths.sure_lo - lo, less = depths.hi - depths.sure_hi;
    depths.lo = -inverse_lo * (1 + 0x1p-50);
    depths.hi = -inverse_hi * (1 - 0x1p-50);
    // -1 / (d + e) <= -1 / d + e / d^2, and -1 / (d - e) >= -1 / d - 2 e / d^2 for e <= d / 2.
    depths.sure_lo = -inverse_lo * (1 - 0x1p-49) + std::max(more, 0.0) * inverse_lo * inverse_lo;
    depths.sure_hi = 2 * less * inverse_hi <= 1 || !(less > 0)
                         ? -inverse_hi * (1 + 2 * std::max(less, 0.0) * inverse_hi + 0x1p-49)
                         : -std::numeric_limits<double>::infinity();
  } else {
    const double slope = std::max(std::abs(x), std::abs(y)), reach = std::abs(q.z) + tree.depth;
    at_x = q.x;
    at_y = q.y;
    radius = (slope + 0x1p-49 * steepness * (1 + slope)) * reach + 0x1p-49 * (1 + slope) * origin_size;
    query.tie_constant = loosely_above(0x1p-22 * std::abs(q.z) + 0x1p-148 * std::abs(m.z));
    query.tie_linear = 0x1p-22f;
    query.tie_square = 0;
  }
  if (!(radius <= kColumnDrift * tree.width && steepness <= 0x1p10)) return false;
  Column& column = query.column;
  column.ascending = m.z > 0;
  const double lo = std::max(static_cast<double>(tree.depths[0]), depths.lo);
  const double hi = std::min(static_cast<double>(tree.depths[1]), depths.hi);
  if (!(lo <= hi)) return true;
  set_sides(column, at_x, at_y, radius);
  column.box.lo.z = loosely_below(lo);
  column.box.hi.z = loosely_above(hi);
  column.sure_lo = loosely_above(std::max(lo, depths.sure_lo));
  column.sure_hi = loosely_below(std::min(hi, depths.sure_hi));
  return true;
}

}  // namespace

FrameUse prepare(const FrameMemory& tree, const Ray& ray, FrameQuery& query) {
  FrameSegment s;
  query.column.box = {};
  if (!(ray.tmin <= ray.tmax)) return FrameUse::kColumn;
  if (std::abs(ray.tmin) < kInf && set_column(tree, ray, query)) return FrameUse::kColumn;
  const FrameFit fit = make_segment(tree.frame, ray, tree.depths, s);
  if (fit == FrameFit::kUnfit) return FrameUse::kUnfit;
  if (fit == FrameFit::kNothing) return FrameUse::kColumn;
  query.tie_constant = loosely_above(s.tie_constant);
  query.tie_linear = loosely_above(s.tie_linear);
  query.tie_square = loosely_above(s.tie_square);
  query.column = to_column(s);
  if (drift(s) + s.error <= kColumnDrift * tree.width) {
    query.column.radius *= 1 + 0x1p-20f;
    return FrameUse::kColumn;
  }
  const double whole = static_cast<double>(tree.depths[1]) - static_cast<double>(tree.depths[0]);
  const double slope = std::max(std::abs(s.slope_x), std::abs(s.slope_y));
  if (!(slope * whole <= kConeDrift * tree.width && s.error <= kColumnDrift * tree.width)) return FrameUse::kUnfit;
  set_cone(tree, s, query);
  return FrameUse::kCone;
}

}  // namespace raygrain
