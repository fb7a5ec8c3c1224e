// Ray space: maps of the world in which the rays of a distribution run along z. Straight lines stay straight, so boxes,
// triangles and rays keep their meaning, and a ray of the distribution becomes a *column*: a point (x, y) and an
// interval of depths. After Hunt and Mark, "Ray-specialized acceleration structures for ray tracing" (2008), who map
// the rays of one eye. docs/theory-frames.md has the proofs.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "raygrain/area.h"
#include "raygrain/bounds.h"
#include "raygrain/ray.h"

namespace raygrain {

/// How a frame maps the world. Parallel rays: turned, or sheared along the rays onto the coordinate plane across an
/// axis (faces parallel to that plane, and edges along its axes, stay so). Rays through a point: (x/z, y/z, -1/z).
enum class FrameKind : uint8_t { kRotation, kShearX, kShearY, kShearZ, kProjective };
inline constexpr FrameKind kFrameKinds[] = {FrameKind::kRotation, FrameKind::kShearX, FrameKind::kShearY,
                                            FrameKind::kShearZ, FrameKind::kProjective};

/// "rotation", "shear_x", "shear_y", "shear_z", "projective".
const char* name(FrameKind kind);

/// A map of the world. With q = (rows . (p - center)), a point p becomes q, or (q.x/q.z, q.y/q.z, -1/q.z) in a
/// projective frame, which shows only what has q.z >= near_z > 0. The numbers are exact as they stand: the map is
/// defined in real arithmetic, and whatever the functions below return allows for their own rounding.
struct RayFrame {
  FrameKind kind = FrameKind::kShearZ;
  std::array<Vec3d, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3d center;  // of parallel rays' scene; the eye of a projective frame
  double near_z = 0;
  double norm = 1;                                           // the largest sum of magnitudes of a row
  Bounds domain{{-kInf, -kInf, -kInf}, {kInf, kInf, kInf}};  // the part of the frame that counts

  bool is_projective() const { return kind == FrameKind::kProjective; }
};

/// A frame for parallel rays along `direction` and things near `center`. Nothing for a shear whose axis is more than 84
/// degrees away from the direction, and for kProjective. Throws Error (kUsage) for a direction that is zero, and where
/// something is not finite.
std::optional<RayFrame> parallel_frame(FrameKind kind, Vec3 direction, Vec3 center);

/// The frame of an influence area; its domain holds the area's region with all slack, and goes on beyond its far face
/// (and, for parallel rays, before its near face). Nothing for kinds that do not suit the area, for a point area
/// whose near plane is closer to the eye than the slack of its region, and for a plane area whose middle is beyond the
/// largest float.
std::optional<RayFrame> area_frame(FrameKind kind, const AreaGeometry& area);

/// The kinds for which area_frame returns one, in the order of the enumeration.
std::vector<FrameKind> frame_kinds(const AreaGeometry& area);

/// A point in the frame, up to rounding. In a projective frame it must lie before the eye.
Vec3d to_frame(const RayFrame& frame, Vec3d point);

/// A box around the triangle's image in the frame's domain (and in `within`), rounded outward by all errors; empty only
/// where nothing of the triangle is there.
Bounds frame_bounds(const RayFrame& frame, Vec3 a, Vec3 b, Vec3 c);
Bounds frame_bounds(const RayFrame& frame, Vec3 a, Vec3 b, Vec3 c, const Bounds& within);

/// The same for a box of the world.
Bounds frame_bounds(const RayFrame& frame, const Bounds& box);

/// A ray in the frame, as far as it lies between two depths: for every point of the ray with tmin <= float(t) <= tmax
/// and z_range[0] <= z <= z_range[1],
///     |x - (x0 + slope_x (z - z0))| <= error, |y - (y0 + slope_y (z - z0))| <= error, and z_lo <= z <= z_hi;
/// and every z in [sure_lo, sure_hi] is the depth of such a point, with tmin < t < tmax.
struct FrameSegment {
  double x0 = 0, y0 = 0, z0 = 0;  // z0 is the middle of z_lo and z_hi
  double slope_x = 0, slope_y = 0, error = 0;
  double slope_error = 0;  // beyond z_lo and z_hi the error grows by this times the distance
  double z_lo = 0, z_hi = 0, sure_lo = 0, sure_hi = 0;
  bool ascending = true;  // z grows with t
  /// Hits whose float t are finite and equal, or in the other order than their depths, differ in depth by at most
  /// tie(z), z being that of either.
  double tie_constant = 0, tie_linear = 0, tie_square = 0;

  double tie(double z) const { return tie_constant + (z < 0 ? -z : z) * tie_linear + z * z * tie_square; }
};

enum class FrameFit {
  kServed,   // as described
  kNothing,  // no part of the ray lies between the depths
  kUnfit,    // the frame cannot tell: the ray runs across its z axis, or is too far away
};

/// Where a valid ray with tmin <= tmax runs, between finite depths. Deterministic: double arithmetic alone.
FrameFit make_segment(const RayFrame& frame, const Ray& ray, std::array<float, 2> z_range, FrameSegment& segment);

/// A segment as a box: what queries of columns read. The ray's part between the depths lies in `box`; the points within
/// `radius` of (x, y), in both coordinates, hold the box's xy extent.
struct FrameColumn {
  Bounds box;
  float x = 0, y = 0, radius = 0;
  float sure_lo = 0, sure_hi = 0;  // every depth in between is one of the ray's, strictly inside [tmin, tmax]
  bool ascending = true;           // t grows with z
};

/// Rounded outward (sure_lo and sure_hi inward). Good for any slope; tight where the ray runs along z.
FrameColumn to_column(const FrameSegment& segment);

/// |slope| times half the depth of the segment: how far the ray leaves its middle line.
double drift(const FrameSegment& segment);

/// Face weights (for face_weight_measure, in the frame) of parallel rays of these directions, equally dense across
/// each: w_k = E|(Mv)_k| |det M^-1| with v of unit length. Exact in rotations and shears; throws Error (kUsage) for
/// projective frames, for no directions, and for a direction that is zero or not finite.
Vec3d frame_face_weights(const RayFrame& frame, std::span<const Vec3> directions);

/// Face weights (E|slope_x|, E|slope_y|, 1) of sample rays in the frame: what replaces E|v| for rays near a point,
/// whose slope is their offset from the eye. Rays that the frame cannot tell do not count; without any: (0, 0, 1).
Vec3d frame_slope_weights(const RayFrame& frame, std::span<const Ray> rays);

/// Face weights of an area's rays within its tolerance, for its own frames: directions evenly spread over the cone of
/// half angle acos(1 - tolerance), for a point area around those of rays that start on its near plane. Tolerance 0:
/// bit for bit those of the area's one direction, or (0, 0, 1) for a point area; towards 1 those of all directions.
/// Throws Error (kUsage) for a projective frame of a plane area and the other way round.
Vec3d frame_area_weights(const RayFrame& frame, const AreaGeometry& area);

}  // namespace raygrain
