#include "raygrain/ray_frame.h"

#include <algorithm>
#include <cmath>

#include "raygrain/error.h"

#include "geometry/cut_polygon.h"
#include "geometry/frame_polygon.h"
#include "geometry/rounding.h"

namespace raygrain {
namespace {

/// A shear's axis has at least this part of the direction's largest component: its map lengthens nothing by more.
constexpr double kLeastShearComponent = 0.1;

Vec3d unit_axis(int axis) {
  Vec3d unit;
  unit[axis] = 1;
  return unit;
}

/// rows . p along the axis that follows, the one after that, and along the rays.
std::optional<std::array<Vec3d, 3>> shear_rows(int axis, Vec3d direction) {
  if (!(std::abs(direction[axis]) >= kLeastShearComponent * largest_component(direction))) return {};
  const int first = (axis + 1) % 3, second = (axis + 2) % 3;
  std::array<Vec3d, 3> rows{unit_axis(first), unit_axis(second), unit_axis(axis)};
  rows[0][axis] = -direction[first] / direction[axis];
  rows[1][axis] = -direction[second] / direction[axis];
  if (direction[axis] < 0) rows[2] = -rows[2];
  return rows;
}

void set_rows(RayFrame& frame, const std::array<Vec3d, 3>& rows) {
  frame.rows = rows;
  frame.norm = 0;
  for (const Vec3d& row : rows) frame.norm = std::max(frame.norm, std::abs(row.x) + std::abs(row.y) + std::abs(row.z));
}

std::optional<RayFrame> parallel_frame_at(FrameKind kind, const Frame& axes, Vec3d center) {
  RayFrame frame;
  frame.kind = kind;
  frame.center = center;
  if (kind == FrameKind::kProjective) return {};
  if (kind == FrameKind::kRotation) {
    set_rows(frame, {axes.right, axes.up, axes.forward});
    return frame;
  }
  const auto rows = shear_rows(static_cast<int>(kind) - static_cast<int>(FrameKind::kShearX), axes.forward);
  if (!rows) return {};
  set_rows(frame, *rows);
  return frame;
}

Vec3d middle(const ConvexRegion& region) {
  Vec3d sum;
  for (const Vec3d corner : region.corners) sum = sum + corner;
  return to_double(to_float(sum * 0.125));
}

/// The domain's x and y, from the region's corners in the frame.
void set_window(RayFrame& frame, std::span<const Vec3d> corners) {
  for (const int axis : {0, 1}) {
    double lo = corners[0][axis], hi = lo, size = 0;
    for (const Vec3d corner : corners) {
      lo = std::min(lo, corner[axis]);
      hi = std::max(hi, corner[axis]);
      size = std::max(size, std::abs(corner[axis]));
    }
    frame.domain.lo[axis] = float_below(lo - 0x1p-30 * size);
    frame.domain.hi[axis] = float_above(hi + 0x1p-30 * size);
  }
}

std::optional<RayFrame> plane_area_frame(FrameKind kind, const AreaGeometry& area) {
  const Vec3d center = middle(area.region());
  if (!is_finite(to_float(center))) return {};  // the area's own corners are beyond floats
  std::optional<RayFrame> frame = parallel_frame_at(kind, area.frame(), center);
  if (!frame) return {};
  std::array<Vec3d, 8> corners;
  std::ranges::transform(area.region().outer_corners, corners.begin(), [&](Vec3d p) { return to_local(*frame, p); });
  set_window(*frame, corners);
  return frame;
}

std::optional<RayFrame> point_area_frame(const AreaGeometry& area) {
  RayFrame frame;
  frame.kind = FrameKind::kProjective;
  frame.center = area.frame().origin;
  set_rows(frame, {area.frame().right, area.frame().up, area.frame().forward});
  std::array<Vec3d, 8> corners;
  double nearest = std::numeric_limits<double>::infinity(), size = 0;
  for (size_t i = 0; i < corners.size(); ++i) {
    corners[i] = to_local(frame, area.region().outer_corners[i]);
    nearest = std::min(nearest, corners[i].z);
    size = std::max(size, largest_component(corners[i]));
  }
  frame.near_z = nearest - 0x1p-40 * size;
  if (!(frame.near_z > 0x1p-20 * size)) return {};
  for (Vec3d& corner : corners) corner = {corner.x / corner.z, corner.y / corner.z, -1 / corner.z};
  set_window(frame, corners);
  frame.domain.lo.z = float_below(-1.0000001 / frame.near_z);
  frame.domain.hi.z = 0;
  return frame;
}

Bounds bounds_in(FramePolygon polygon, const Bounds& box) {
  if (is_empty(box) || (polygon.count == 0 && !polygon.is_unknown)) return {};
  if (polygon.is_unknown) return box;
  Vec3d size, margin;
  for (size_t i = 0; i < polygon.count; ++i) {
    const Vec3d p = polygon.corners[i];
    size = component_max(size, {std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  for (int axis = 0; axis < 3; ++axis) {
    margin[axis] = 2 * polygon.padding[axis] + 0x1p-40 * size[axis];
    if (box.lo[axis] > -kInf) cut(polygon, axis, static_cast<double>(box.lo[axis]) - margin[axis], -1);
    if (box.hi[axis] < kInf) cut(polygon, axis, static_cast<double>(box.hi[axis]) + margin[axis], 1);
  }
  if (polygon.count == 0) return {};
  Bounds part;
  for (int axis = 0; axis < 3; ++axis) {
    double lo = polygon.corners[0][axis], hi = lo;
    for (size_t i = 1; i < polygon.count; ++i) {
      lo = std::min(lo, polygon.corners[i][axis]);
      hi = std::max(hi, polygon.corners[i][axis]);
    }
    part.lo[axis] = float_below(lo - margin[axis]);
    part.hi[axis] = float_above(hi + margin[axis]);
  }
  part = intersected(part, box);
  return is_empty(part) ? Bounds{} : part;
}

}  // namespace

const char* name(FrameKind kind) {
  switch (kind) {
    case FrameKind::kRotation:
      return "rotation";
    case FrameKind::kShearX:
      return "shear_x";
    case FrameKind::kShearY:
      return "shear_y";
    case FrameKind::kShearZ:
      return "shear_z";
    case FrameKind::kProjective:
      return "projective";
  }
  return "?";
}

std::optional<RayFrame> parallel_frame(FrameKind kind, Vec3 direction, Vec3 center) {
  if (!is_finite(direction) || direction == Vec3{} || !is_finite(center))
    throw Error(ErrorCode::kUsage, "parallel_frame", "the direction is zero or something is not finite");
  return parallel_frame_at(kind, make_frame(to_double(center), to_double(direction), {0, 1, 0}), to_double(center));
}

std::optional<RayFrame> area_frame(FrameKind kind, const AreaGeometry& area) {
  if (area.is_plane()) return plane_area_frame(kind, area);
  if (kind != FrameKind::kProjective) return {};
  return point_area_frame(area);
}

std::vector<FrameKind> frame_kinds(const AreaGeometry& area) {
  std::vector<FrameKind> kinds;
  for (const FrameKind kind : kFrameKinds)
    if (area_frame(kind, area)) kinds.push_back(kind);
  return kinds;
}

Vec3d to_frame(const RayFrame& frame, Vec3d point) {
  const Vec3d q = to_local(frame, point);
  return frame.is_projective() ? Vec3d{q.x / q.z, q.y / q.z, -1 / q.z} : q;
}

Bounds frame_bounds(const RayFrame& frame, Vec3 a, Vec3 b, Vec3 c) {
  return bounds_in(frame_polygon(frame, a, b, c), frame.domain);
}

Bounds frame_bounds(const RayFrame& frame, Vec3 a, Vec3 b, Vec3 c, const Bounds& within) {
  return bounds_in(frame_polygon(frame, a, b, c), intersected(frame.domain, within));
}

// The box's image is convex, and its extreme points are those of the images of its faces.
Bounds frame_bounds(const RayFrame& frame, const Bounds& box) {
  RayFrame whole = frame;
  for (int axis = 0; axis < 3; ++axis) {
    whole.domain.lo[axis] = frame.is_projective() && axis == 2 ? whole.domain.lo[axis] : -kInf;
    whole.domain.hi[axis] = frame.is_projective() && axis == 2 ? whole.domain.hi[axis] : kInf;
  }
  Bounds image;
  if (is_empty(box)) return image;
  for (int axis = 0; axis < 3; ++axis) {
    const int first = 1 << (axis + 1) % 3, second = 1 << (axis + 2) % 3;
    for (const int side : {0, 1 << axis}) {
      const Vec3 p = corner(box, side), q = corner(box, side | first), r = corner(box, side | second);
      image.extend(frame_bounds(whole, p, q, r));
      image.extend(frame_bounds(whole, q, r, corner(box, side | first | second)));
    }
  }
  image = intersected(image, frame.domain);
  return is_empty(image) ? Bounds{} : image;
}

}  // namespace raygrain
