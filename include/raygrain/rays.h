// Ray casters: seeded sets of rays that follow influence areas, cameras, or run from surfaces to lights. All are
// deterministic: the same options give the same rays, bit for bit, on every machine. A ray depends on the seed and its
// index alone: of two sets that differ in count, one is the beginning of the other.
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "raygrain/area.h"
#include "raygrain/mesh.h"
#include "raygrain/ray.h"

namespace raygrain {

enum class RayStart {
  kNear,         // on the face (plane area) or near plane (point area) where rays start
  kRandomDepth,  // uniformly distributed depth inside the region
};

enum class PointSpread {
  kNearPlane,  // uniform on the near plane: what projected area assumes
  kAngle,  // uniform in yaw and pitch, as the paper's published runs; near the corners up to a fifth leave the window
};

/// Rays of an influence area. Those of a plane area have its direction exactly (normalised, rounded once to float), the
/// same for all; those of a point area have unit length up to rounding; tmin is 0 and tmax infinite. The area serves
/// every ray whose origin is in its region, which jitter and kAngle may leave, and whose cone is within its tolerance.
struct AreaRays {
  InfluenceArea area;
  RayStart start = RayStart::kNear;
  PointSpread spread = PointSpread::kNearPlane;
  float cone_degrees = 0;   // directions uniform in a spherical cap of this half angle around the exact one, [0, 90]
  float jitter_radius = 0;  // origins moved uniformly on a disc of this radius perpendicular to the area's axis
};

/// Shadow rays from uniformly chosen surface points (by area), on the side that faces the target, moved off the surface
/// by 1e-4 of the scene's diagonal, towards a direction, a point or a rectangle. Rays to a point or rectangle have the
/// direction float32(target - origin), tmin 0 and tmax 1: they end at the target.
struct TowardsDirection {
  Vec3 direction;  // direction in which the *light* travels; rays go against it, unit length, tmax infinite
};
struct TowardsPoint {
  Vec3 point;
};
struct TowardsRectangle {
  Vec3 center, half_u, half_v;  // center +- half_u +- half_v, sampled uniformly
};
struct SurfaceRays {
  std::variant<TowardsDirection, TowardsPoint, TowardsRectangle> target;
};

/// One ray of unit length through the middle of each pixel, row by row from the viewer's top left; not mirrored.
struct CameraRays {
  Vec3 eye, target, up{0, 1, 0};
  float fov_y = 60;  // degrees
  uint32_t width = 64, height = 64;
};

/// `count` rays. Each throws Error (kUsage or kBadArea) for options out of range.
std::vector<Ray> cast_rays(const AreaRays& options, size_t count, uint64_t seed);
/// Fewer than `count` only for a mesh without area (none at all).
std::vector<Ray> cast_rays(const SurfaceRays& options, const TriangleMesh& mesh, size_t count, uint64_t seed);
std::vector<Ray> cast_rays(const CameraRays& options);

/// A direction in the coordinates of an area's frame, by angles in radians (at most 1e6): yaw about `up`, towards
/// `right`; then pitch, down. (0, 0, 1) is straight on. Unit length up to rounding; the same bits on every machine. For
/// ray casters of one's own.
Vec3d angular_direction(double yaw, double pitch);

/// A regular grid of width x height rays over an area's window, row by row from the top left, starting on the near
/// face: the pixels of a picture seen from the area, not mirrored (the frame's `right` is on a viewer's left). Throws
/// Error (kUsage or kBadArea).
std::vector<Ray> window_grid_rays(const InfluenceArea& area, uint32_t width, uint32_t height);

}  // namespace raygrain
