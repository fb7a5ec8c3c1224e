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

/// Directions further from the z axis than this tangent, and origins further from the eye (in near_z), are not for
/// frames.
constexpr double kSteepest = 0x1p10, kFarthest = 0x1p18;

/// One coordinate of a cone: x = intercept + slope z, wrong by at most `error` at the tree's depths.
struct ConeSide {
  float intercept, slope, inverse, near, far;
  double error;  // of intercept + slope z, evaluated in float
};

ConeSide cone_side(const FrameMemory& tree, double intercept, double slope, double error) {
  const double steep = std::copysign(std::max(std::abs(slope), tree.least_slope), slope);
  const double inverse_in_double = 1 / steep;
  ConeSide side{};
  side.inverse = static_cast<float>(inverse_in_double);
  const double inverse = side.inverse, size = std::abs(steep);
  error += (size - std::abs(slope) + 0x1p-23 * size) * 2 * tree.depth;  // from the slope to 1 / inverse
  const double offset = -intercept * inverse;
  const double slack = std::abs(inverse) * (error + 0x1p-22 * tree.width) + 0x1p-22 * tree.depth;
  side.near = loosely_below(offset - slack);
  side.far = loosely_above(offset + slack);
  side.slope = static_cast<float>(steep);
  side.intercept = static_cast<float>(intercept);
  side.error = error + 0x1p-21 * (tree.reach + size * tree.depth + std::abs(intercept));
  return side;
}

void set_cone(const FrameMemory& tree, Vec2d intercept, Vec2d slope, double error, FrameQuery& query) {
  const ConeSide x = cone_side(tree, intercept.x, slope.x, error), y = cone_side(tree, intercept.y, slope.y, error);
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

void set_sides(FrameColumn& column, double x, double y, double radius) {
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

/// To the depths of a projective frame; false where all is before the near plane.
bool project(Depths& depths, double near_z) {
  if (depths.hi < near_z) return false;
  const double lo = std::max(depths.lo, near_z), inverse_lo = 1 / lo, inverse_hi = 1 / depths.hi;
  const double more = std::max(depths.sure_lo - lo, 0.0), less = depths.hi - depths.sure_hi;  // NaN at infinity
  depths.lo = -inverse_lo * (1 + 0x1p-50);
  depths.hi = -inverse_hi * (1 - 0x1p-50);
  // -1 / (d + e) <= -1 / d + e / d^2, and -1 / (d - e) >= -1 / d - 2 e / d^2 for e <= d / 2.
  depths.sure_lo = -inverse_lo * (1 - 0x1p-49) + more * inverse_lo * inverse_lo;
  const bool is_far = 2 * less * inverse_hi > 1;
  depths.sure_hi = is_far ? -std::numeric_limits<double>::infinity()
                          : -inverse_hi * (1 + 2 * std::max(0.0, less) * inverse_hi + 0x1p-49);
  return true;
}

/// The ray as x = intercept + slope z, in frame coordinates.
struct FrameLine {
  Vec2d intercept, slope;
  double error;   // at every depth of the tree
  Vec2d at;       // x and y of a column
  double radius;  // of that column
};

FrameLine parallel_line(const FrameMemory& tree, Vec3d q, Vec2d slope, double origin_size, double steepness,
                        FrameQuery& query, double speed) {
  const double lean = 1 + std::max(std::abs(slope.x), std::abs(slope.y)), reach = std::abs(q.z) + tree.depth;
  const double error = 0x1p-49 * lean * (origin_size + 2 * steepness * reach);
  query.tie_constant = loosely_above(0x1p-22 * std::abs(q.z) + 0x1p-148 * std::abs(speed));
  query.tie_linear = 0x1p-22f;
  query.tie_square = 0;
  return {{q.x - q.z * slope.x, q.y - q.z * slope.y}, slope, error, {q.x, q.y}, (lean - 1) * reach + error};
}

FrameLine projective_line(const FrameMemory& tree, Vec3d q, Vec2d x, double origin_size, double steepness,
                          FrameQuery& query, double speed) {
  const double lean = 1 + std::max(std::abs(x.x), std::abs(x.y));
  const double error = 0x1p-48 * steepness * lean * (1 + tree.depth * origin_size);
  const Vec2d slope{q.z * x.x - q.x, q.z * x.y - q.y};
  query.tie_constant = 0;
  query.tie_linear = 0x1p-20f;
  query.tie_square = loosely_above(0x1p-20 * std::abs(q.z) + 0x1p-147 * std::abs(speed));
  return {x,
          slope,
          error,
          {x.x + tree.middle * slope.x, x.y + tree.middle * slope.y},
          std::max(std::abs(slope.x), std::abs(slope.y)) * tree.half + error};
}

/// The depths that the ray and the tree have in common; false where there are none.
bool set_depths(const FrameMemory& tree, const Depths& depths, FrameColumn& column) {
  const double lo = std::max(static_cast<double>(tree.depths[0]), depths.lo);
  const double hi = std::min(static_cast<double>(tree.depths[1]), depths.hi);
  if (!(lo <= hi)) return false;
  column.box.lo.z = loosely_below(lo);
  column.box.hi.z = loosely_above(hi);
  column.sure_lo = loosely_above(std::max(lo, depths.sure_lo));
  column.sure_hi = loosely_below(std::min(hi, depths.sure_hi));
  return true;
}

}  // namespace

FrameUse prepare(const FrameMemory& tree, const Ray& ray, FrameQuery& query) {
  query.column.box = {};
  if (!(ray.tmin <= ray.tmax)) return FrameUse::kColumn;
  if (std::abs(ray.tmin) == kInf) return FrameUse::kUnfit;
  const RayFrame& frame = tree.frame;
  const Vec3d offset = to_double(ray.origin) - frame.center, direction = to_double(ray.direction);
  const Vec3d q = turned(frame, offset), m = turned(frame, direction);
  const double origin_size = frame.norm * largest(offset), direction_size = frame.norm * largest(direction);
  const double inverse = 1 / m.z, steepness = direction_size * std::abs(inverse);
  Depths depths(ray, q.z, m.z, origin_size, direction_size);
  // Where t overflows, hits at any depth have the same t.
  constexpr double kLongest = 0x1p126;
  if (!(steepness <= kSteepest && (std::abs(q.z) + tree.farthest) * std::abs(inverse) <= kLongest))
    return FrameUse::kUnfit;
  query.origin_z = q.z;
  query.speed_z = m.z;
  query.origin_error = 0x1p-49 * origin_size;
  query.speed_error = 0x1p-49 * direction_size;
  query.is_projective = frame.is_projective();
  FrameLine line;
  if (frame.is_projective()) {
    if (!(origin_size <= kFarthest * frame.near_z)) return FrameUse::kUnfit;
    line = projective_line(tree, q, {m.x * inverse, m.y * inverse}, origin_size, steepness, query, m.z);
    if (!project(depths, frame.near_z)) return FrameUse::kColumn;
  } else {
    line = parallel_line(tree, q, {m.x * inverse, m.y * inverse}, origin_size, steepness, query, m.z);
  }
  const bool is_column = line.radius <= kColumnDrift * tree.width;
  const double slope = std::max(std::abs(line.slope.x), std::abs(line.slope.y));
  if (!is_column && !(slope * 2 * tree.half <= kConeDrift * tree.width && line.error <= kColumnDrift * tree.width))
    return FrameUse::kUnfit;

  query.column.ascending = m.z > 0;
  if (!set_depths(tree, depths, query.column)) return FrameUse::kColumn;
  if (is_column) {
    set_sides(query.column, line.at.x, line.at.y, line.radius);
    return FrameUse::kColumn;
  }
  query.column.box.lo.x = query.column.box.lo.y = -kInf;
  query.column.box.hi.x = query.column.box.hi.y = kInf;
  set_cone(tree, line.intercept, line.slope, line.error, query);
  return FrameUse::kCone;
}

}  // namespace raygrain
