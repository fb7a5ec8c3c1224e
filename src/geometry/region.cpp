#include "raygrain/region.h"

#include <cmath>

namespace raygrain {

namespace {

double largest_component(Vec3d v) {
  return std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z)));
}

double slack_of(const std::array<Vec3d, 8>& corners, Vec3d origin) {
  double coordinate = 0, diameter = 0;
  for (const Vec3d corner : corners) {
    coordinate = std::fmax(coordinate, largest_component(corner));
    for (const Vec3d other : corners) diameter = std::fmax(diameter, length(other - corner));
  }
  return 0x1p-20 * (coordinate + diameter + 0x1p-20 * largest_component(origin));
}

// Half the size of the cross-section at both ends of a hexahedron around a frame's forward axis.
struct Profile {
  double near_x, near_y, near_z, far_x, far_y, far_z;
};

std::array<Vec3d, 8> profile_corners(const Frame& frame, const Profile& profile) {
  std::array<Vec3d, 8> corners;
  for (size_t i = 0; i < 8; ++i) {
    const bool far = (i & 4) != 0;
    const double x = far ? profile.far_x : profile.near_x, y = far ? profile.far_y : profile.near_y;
    corners[i] = to_world(frame, {(i & 1) ? x : -x, (i & 2) ? y : -y, far ? profile.far_z : profile.near_z});
  }
  return corners;
}

// The plane with this normal that touches the corners from outside.
Plane touching_plane(Vec3d normal, const std::array<Vec3d, 8>& corners) {
  Plane plane{normal, dot(normal, corners[0])};
  for (const Vec3d corner : corners) plane.offset = std::fmax(plane.offset, dot(normal, corner));
  return plane;
}

// The side planes lean by the tangents `tan_x` and `tan_y`: 0 for boxes.
void set_planes(ConvexRegion& region, const Frame& frame, double tan_x, double tan_y) {
  const Vec3d lean_x = frame.forward * tan_x, lean_y = frame.forward * tan_y;
  const std::array<Vec3d, 6> normals{-frame.right - lean_x, frame.right - lean_x, -frame.up - lean_y,
                                     frame.up - lean_y,     -frame.forward,       frame.forward};
  for (size_t i = 0; i < 6; ++i) region.planes[i] = touching_plane(normalized(normals[i]), region.corners);
}

}  // namespace

ConvexRegion box_region(const Bounds& box) {
  ConvexRegion region;
  Vec3d lo = to_double(box.lo), hi = to_double(box.hi);
  for (int i = 0; i < 8; ++i) region.corners[static_cast<size_t>(i)] = to_double(corner(box, i));
  region.slack = slack_of(region.corners, {});
  const Vec3d margin = Vec3d{1, 1, 1} * (2 * region.slack);
  lo = lo - margin;
  hi = hi + margin;
  for (size_t i = 0; i < 8; ++i)
    region.outer_corners[i] = {(i & 1) ? hi.x : lo.x, (i & 2) ? hi.y : lo.y, (i & 4) ? hi.z : lo.z};
  set_planes(region, Frame{}, 0, 0);
  region.edges = {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  region.edge_count = 3;
  return region;
}

ConvexRegion oriented_box_region(const Frame& frame, double half_width, double half_height, double depth) {
  ConvexRegion region;
  region.corners = profile_corners(frame, {half_width, half_height, 0, half_width, half_height, depth});
  region.slack = slack_of(region.corners, frame.origin);
  const double margin = 2 * region.slack, outer_x = half_width + margin, outer_y = half_height + margin;
  region.outer_corners = profile_corners(frame, {outer_x, outer_y, -margin, outer_x, outer_y, depth + margin});
  set_planes(region, frame, 0, 0);
  region.edges = {frame.right, frame.up, frame.forward};
  region.edge_count = 3;
  return region;
}

ConvexRegion frustum_region(const Frame& frame, double tan_half_x, double tan_half_y, double near_z, double far_z) {
  ConvexRegion region;
  region.corners = profile_corners(frame, {tan_half_x * near_z, tan_half_y * near_z, near_z,  //
                                           tan_half_x * far_z, tan_half_y * far_z, far_z});
  region.slack = slack_of(region.corners, frame.origin);
  // A side plane moved out by m crosses the plane z at tan * z + m * sqrt(1 + tan^2), which is positive for z >= -m.
  const double margin = 2 * region.slack, outer_near = near_z - margin, outer_far = far_z + margin;
  const double wide_x = margin * std::sqrt(1 + tan_half_x * tan_half_x);
  const double wide_y = margin * std::sqrt(1 + tan_half_y * tan_half_y);
  region.outer_corners =
      profile_corners(frame, {tan_half_x * outer_near + wide_x, tan_half_y * outer_near + wide_y, outer_near,  //
                              tan_half_x * outer_far + wide_x, tan_half_y * outer_far + wide_y, outer_far});
  set_planes(region, frame, tan_half_x, tan_half_y);
  region.edges = {frame.right, frame.up};
  for (size_t i = 0; i < 4; ++i)
    region.edges[2 + i] = normalized(
        to_world_direction(frame, {(i & 1) ? tan_half_x : -tan_half_x, (i & 2) ? tan_half_y : -tan_half_y, 1}));
  region.edge_count = 6;
  return region;
}

bool contains(const ConvexRegion& region, Vec3 point) {
  const Vec3d p = to_double(point);
  for (const Plane& plane : region.planes)
    if (!(dot(plane.normal, p) <= plane.offset + region.slack)) return false;  // also for NaN
  return true;
}

bool encloses(const ConvexRegion& region, const Bounds& box) {
  if (is_empty(box)) return false;
  const Vec3d lo = to_double(box.lo), hi = to_double(box.hi);
  for (const Plane& plane : region.planes) {
    const Vec3d farthest{plane.normal.x > 0 ? hi.x : lo.x, plane.normal.y > 0 ? hi.y : lo.y,
                         plane.normal.z > 0 ? hi.z : lo.z};
    // A little less than the slack, so that rounding cannot keep `contains` from agreeing for each point of the box.
    if (!(dot(plane.normal, farthest) <= plane.offset + 0.75 * region.slack)) return false;
  }
  return true;
}

Bounds region_bounds(const ConvexRegion& region) {
  constexpr double kMax = std::numeric_limits<float>::max();
  Bounds box;
  for (const Vec3d corner : region.outer_corners)
    for (int axis = 0; axis < 3; ++axis) {
      const double value = std::fmin(std::fmax(corner[axis], -kMax), kMax);
      const float rounded = static_cast<float>(value);
      const float below = rounded > -kMax ? std::nextafter(rounded, -kInf) : rounded;
      const float above = rounded < kMax ? std::nextafter(rounded, kInf) : rounded;
      box.lo[axis] = std::fmin(box.lo[axis], rounded > value ? below : rounded);
      box.hi[axis] = std::fmax(box.hi[axis], rounded < value ? above : rounded);
    }
  return box;
}

}  // namespace raygrain
