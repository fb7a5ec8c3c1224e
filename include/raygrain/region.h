// Convex regions: boxes, oriented boxes and frusta, all as six planes and eight corners.
#pragma once

#include <array>

#include "raygrain/bounds.h"
#include "raygrain/frame.h"
#include "raygrain/ray.h"

namespace raygrain {

/// The half space dot(normal, p) <= offset; the normal has unit length and points outward.
struct Plane {
  Vec3d normal;
  double offset = 0;
};

/// A convex hexahedron. Corner i: bit 0 = +right, bit 1 = +up, bit 2 = far, as in `corner(Bounds, i)`.
///
/// Every test is conservative by `slack`, a length that exceeds all rounding of float input on this region's scale
/// (docs/theory-areas.md): a point is inside when it is within `slack` of all planes; a triangle or box overlaps when
/// some point of it is within 2 * slack of all planes. So whatever a ray that starts inside meets at or before
/// `exit_distance` overlaps the region.
struct ConvexRegion {
  std::array<Plane, 6> planes;
  std::array<Vec3d, 8> corners;
  std::array<Vec3d, 8> outer_corners;  // of the hexahedron whose planes are moved out by 2 * slack
  std::array<Vec3d, 6> edges;          // unit directions of the edges, `edge_count` of them distinct
  int edge_count = 0;
  double slack = 0;
};

/// The region of an axis-aligned box, finite and not empty.
ConvexRegion box_region(const Bounds& box);

/// The box centred on the frame's axes: |x| <= half_width, |y| <= half_height, 0 <= z <= depth in frame coordinates.
ConvexRegion oriented_box_region(const Frame& frame, double half_width, double half_height, double depth);

/// The frustum |x| <= tan_half_x * z, |y| <= tan_half_y * z, near_z <= z <= far_z in frame coordinates.
ConvexRegion frustum_region(const Frame& frame, double tan_half_x, double tan_half_y, double near_z, double far_z);

/// Is the point inside (within slack)?
bool contains(const ConvexRegion& region, Vec3 point);

/// Does the closed triangle come within 2 * slack? By separating axes (Eberly, "Intersection of convex objects: the
/// method of separating axes", 2001). Degenerate triangles (segments, points) are tested as what they are.
bool overlaps(const ConvexRegion& region, Vec3 a, Vec3 b, Vec3 c);
bool overlaps(const ConvexRegion& region, const Bounds& box);

/// Is the whole box inside (within slack)? An empty box is not.
bool encloses(const ConvexRegion& region, const Bounds& box);

/// The ray parameter t >= 0 at which a ray that starts inside leaves the region, rounded down: every hit that is
/// returned with 0 <= t <= exit_distance lies within 2 * slack, so its triangle overlaps. -infinity (no hit is before
/// it) for an origin outside, and for directions so long that the rounding of t alone exceeds the slack.
float exit_distance(const ConvexRegion& region, const Ray& ray);

/// The part of a ray, extended both ways, that is inside, rounded inward: every hit that is returned with
/// enter <= t <= exit lies within 2 * slack. Nothing is inside when enter > exit.
struct RayInterval {
  float enter = kInf, exit = -kInf;
};
RayInterval inside_interval(const ConvexRegion& region, const Ray& ray);

/// The axis-aligned box around the region with its slack, rounded outward.
Bounds region_bounds(const ConvexRegion& region);

}  // namespace raygrain
