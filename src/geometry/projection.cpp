// How large boxes look to an area's rays. Builders ask this some 10^8 times, so boxes that project into the window take
// a short way without heap or clipping.
#include <algorithm>
#include <cmath>

#include "raygrain/area.h"
#include "raygrain/error.h"

#include "geometry/clip.h"
#include "geometry/solid_angle.h"

namespace raygrain {

namespace {

// Corner coordinates in a frame as sums of one column per axis: corner i is x[i & 1] + y[i >> 1 & 1] + z[i >> 2].
struct LocalBox {
  Vec3d x[2], y[2], z[2];

  LocalBox(const Frame& f, const Bounds& box) {
    const Vec3d lo = to_double(box.lo) - f.origin, hi = to_double(box.hi) - f.origin;
    const Vec3d column_x{f.right.x, f.up.x, f.forward.x}, column_y{f.right.y, f.up.y, f.forward.y};
    const Vec3d column_z{f.right.z, f.up.z, f.forward.z};
    x[0] = column_x * lo.x, x[1] = column_x * hi.x;
    y[0] = column_y * lo.y, y[1] = column_y * hi.y;
    z[0] = column_z * lo.z, z[1] = column_z * hi.z;
  }
  Vec3d corner(int i) const { return x[i & 1] + y[i >> 1 & 1] + z[i >> 2]; }
  double min_depth() const { return std::min(x[0].z, x[1].z) + std::min(y[0].z, y[1].z) + std::min(z[0].z, z[1].z); }
  double max_depth() const { return std::max(x[0].z, x[1].z) + std::max(y[0].z, y[1].z) + std::max(z[0].z, z[1].z); }
};

struct Outline {
  std::array<Vec2d, 6> points;
  size_t count = 0;
  double min_x = 1e300, max_x = -1e300, min_y = 1e300, max_y = -1e300;

  void push(Vec2d p) {
    points[count++] = p;
    min_x = std::min(min_x, p.x), max_x = std::max(max_x, p.x);
    min_y = std::min(min_y, p.y), max_y = std::max(max_y, p.y);
  }
  std::span<const Vec2d> span() const { return {points.data(), count}; }
  ConvexPolygon polygon() const {
    ConvexPolygon result;
    for (size_t i = 0; i < count; ++i) result.push(points[i]);
    return result;
  }
};

Outline plane_outline(const Frame& frame, const Bounds& box) {
  const LocalBox local(frame, box);
  Outline outline;
  for (const int i : contour_corners(visible_faces_along(frame.forward))) {
    const Vec3d p = local.corner(i);
    outline.push({p.x, p.y});
  }
  return outline;
}

// For boxes in front of the eye: min_depth() > 0.
Outline point_outline(const LocalBox& local, Vec3d eye, const Bounds& box) {
  Outline outline;
  for (const int i : contour_corners(visible_faces_from(eye, box))) {
    const Vec3d p = local.corner(i);
    const double inverse = 1 / p.z;
    outline.push({p.x * inverse, p.y * inverse});
  }
  return outline;
}

// A flat box seen from its own plane, or a box without any face, has no area, whatever rounding makes of its outline.
bool is_edge_on(Vec3d eye, const Bounds& box) {
  int flat = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (box.lo[axis] != box.hi[axis]) continue;
    if (++flat == 2 || eye[axis] == static_cast<double>(box.lo[axis])) return true;
  }
  return false;
}

// The outline of a box after clipping to near_z <= z <= far_z: the hull of the corners and edge points that are left.
ConvexPolygon clipped_hull(const LocalBox& local, double near_z, double far_z, bool perspective) {
  std::array<Vec2d, 32> points;
  size_t count = 0;
  const auto push = [&](double x, double y, double z) {
    points[count++] = perspective ? Vec2d{x / z, y / z} : Vec2d{x, y};
  };
  for (int i = 0; i < 8; ++i) {
    const Vec3d p = local.corner(i);
    if (near_z <= p.z && p.z <= far_z) push(p.x, p.y, p.z);
    for (int bit = 1; bit < 8; bit *= 2) {
      if (i & bit) continue;
      const Vec3d q = local.corner(i | bit);
      for (const double depth : {near_z, far_z}) {
        if (!((p.z < depth && depth < q.z) || (q.z < depth && depth < p.z))) continue;
        const double t = (depth - p.z) / (q.z - p.z);
        push(p.x + (q.x - p.x) * t, p.y + (q.y - p.y) * t, depth);
      }
    }
  }
  return convex_hull({points.data(), count});
}

double half_extent(Vec3d axis, Vec3d size) {
  return 0.5 * (std::fabs(axis.x) * size.x + std::fabs(axis.y) * size.y + std::fabs(axis.z) * size.z);
}

Vec3d size_of(const Bounds& box) {
  return to_double(box.hi) - to_double(box.lo);
}

double face_area_sum(Vec3d weights, Vec3d size) {
  return std::fabs(weights.x) * size.y * size.z + std::fabs(weights.y) * size.z * size.x +
         std::fabs(weights.z) * size.x * size.y;
}

// How far from the middle an outline's solid angle is measured if no window bounds it: farther out digits are lost, and
// all that lies there is 9e-5 of a steradian.
constexpr double kFarthestSight = 0x1p16;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// How outlines are measured: by their area, or by their solid angle at the eye.
struct ByArea {
  static double size(std::span<const Vec2d> outline) { return shoelace_area(outline); }
  static double culled_size(const ConvexPolygon& outline, Vec2d half) {
    return std::min(polygon_area(clip_to_window(outline, half)), 4 * half.x * half.y);
  }
};

struct BySolidAngle {
  static double size(std::span<const Vec2d> outline) { return solid_angle(outline); }
  static double culled_size(const ConvexPolygon& outline, Vec2d half) {
    const ConvexPolygon inside = clip_to_window(outline, half);
    const bool covers_window = polygon_area(inside) >= 4 * half.x * half.y;
    return covers_window ? rectangle_solid_angle(half) : solid_angle(inside.span());
  }
};

// Of the part of an outline inside the window.
template <class By>
double culled_size(const Outline& outline, Vec2d half) {
  if (outline.min_x >= -half.x && outline.max_x <= half.x && outline.min_y >= -half.y && outline.max_y <= half.y)
    return By::size(outline.span());
  if (outline.min_x >= half.x || outline.max_x <= -half.x || outline.min_y >= half.y || outline.max_y <= -half.y)
    return 0;
  return By::culled_size(outline.polygon(), half);
}

double plane_area(const Frame& frame, Vec2d half, const Bounds& box, Culling culling) {
  const Vec3d size = size_of(box);
  const double whole = face_area_sum(frame.forward, size);
  if (culling == Culling::kNone) return whole;
  const Vec3d middle = to_double(box.lo) + size * 0.5 - frame.origin;
  const double x = std::fabs(dot(frame.right, middle)), y = std::fabs(dot(frame.up, middle));
  const double reach_x = half_extent(frame.right, size), reach_y = half_extent(frame.up, size);
  if (x + reach_x <= half.x && y + reach_y <= half.y) return std::min(whole, 4 * half.x * half.y);
  if (x - reach_x >= half.x || y - reach_y >= half.y) return 0;
  return std::min(culled_size<ByArea>(plane_outline(frame, box), half),
                  whole);  // exactly 0 for flat boxes seen edge-on
}

// What a point area's rays see of a box.
template <class By>
double point_size(const Frame& frame, double near_z, Vec2d half, const Bounds& box, Culling culling) {
  if (is_edge_on(frame.origin, box)) return 0;
  const LocalBox local(frame, box);
  if (local.min_depth() >= near_z) {
    const Outline outline = point_outline(local, frame.origin, box);
    return culling == Culling::kNone ? By::size(outline.span()) : culled_size<By>(outline, half);
  }
  if (local.max_depth() < near_z) return 0;
  const ConvexPolygon hull = clipped_hull(local, near_z, kUnbounded, true);
  return culling == Culling::kNone ? By::size(hull.span()) : By::culled_size(hull, half);
}

}  // namespace

ConvexPolygon AreaGeometry::projected_hull(const Bounds& box, Culling culling) const {
  if (is_empty(box)) return {};
  ConvexPolygon hull;
  if (is_plane()) {
    hull = plane_outline(frame_, box).polygon();
  } else {
    const LocalBox local(frame_, box);
    hull = local.min_depth() >= near_z_ ? point_outline(local, frame_.origin, box).polygon()
                                        : clipped_hull(local, near_z_, kUnbounded, true);
  }
  return culling == Culling::kNone ? hull : clip_to_window(hull, window_half_);
}

double AreaGeometry::projected_area(const Bounds& box, Culling culling) const {
  if (is_empty(box)) return 0;
  if (is_plane()) return plane_area(frame_, window_half_, box, culling);
  return point_size<ByArea>(frame_, near_z_, window_half_, box, culling);
}

double AreaGeometry::solid_angle(const Bounds& box, Culling culling) const {
  if (is_plane()) throw Error(ErrorCode::kUsage, area_.name, "is a plane area: its rays have no eye");
  if (is_empty(box)) return 0;
  const bool is_culled = culling == Culling::kWindow;
  const Vec2d half{is_culled ? window_half_.x : std::max(window_half_.x, kFarthestSight),
                   is_culled ? window_half_.y : std::max(window_half_.y, kFarthestSight)};
  return point_size<BySolidAngle>(frame_, near_z_, half, box, Culling::kWindow);
}

double AreaGeometry::window_solid_angle() const {
  if (is_plane()) throw Error(ErrorCode::kUsage, area_.name, "is a plane area: its rays have no eye");
  return rectangle_solid_angle(window_half_);
}

double AreaGeometry::hit_probability(const Bounds& box) const {
  if (is_empty(box)) return 0;
  const LocalBox local(frame_, box);
  const double lowest = local.min_depth(), highest = local.max_depth();
  if (highest < near_z_ || lowest > far_z_) return 0;
  const double whole = projected_area(box, Culling::kWindow);
  if (whole == 0 || (lowest >= near_z_ && highest <= far_z_)) return std::min(whole / window_area(), 1.0);
  const double part = ByArea::culled_size(clipped_hull(local, near_z_, far_z_, !is_plane()), window_half_);
  return std::min(std::min(part, whole) / window_area(), 1.0);
}

Vec3d parallel_face_weights(Vec3d direction) {
  return {std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)};
}

double three_parallelogram_area(const Frame& frame, const Bounds& box) {
  const Vec3d size = size_of(box);
  const Vec2d x{frame.right.x * size.x, frame.up.x * size.x}, y{frame.right.y * size.y, frame.up.y * size.y},
      z{frame.right.z * size.z, frame.up.z * size.z};
  const auto parallelogram = [](Vec2d a, Vec2d b) { return std::fabs(a.x * b.y - a.y * b.x); };
  return parallelogram(x, y) + parallelogram(y, z) + parallelogram(z, x);
}

}  // namespace raygrain
