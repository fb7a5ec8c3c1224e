// Orthonormal frames: the local axes of an influence area, with its rays along +z (forward).
#pragma once

#include "raygrain/vec.h"

namespace raygrain {

/// A right-handed look-along frame in double precision: right = up x forward normalised, up made perpendicular.
struct Frame {
  Vec3d origin, right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, 1};
};

/// The frame that looks along `forward` (any length but zero) with `up` as near to the given one as can be. An `up`
/// that is zero or parallel to `forward` (vertical lights) is replaced by the coordinate axis least parallel to it.
Frame make_frame(Vec3d origin, Vec3d forward, Vec3d up);

/// World to frame coordinates: (along right, along up, along forward).
constexpr Vec3d to_local_direction(const Frame& f, Vec3d v) {
  return {dot(v, f.right), dot(v, f.up), dot(v, f.forward)};
}
constexpr Vec3d to_local(const Frame& f, Vec3d p) {
  return to_local_direction(f, p - f.origin);
}
constexpr Vec3d to_world_direction(const Frame& f, Vec3d v) {
  return f.right * v.x + f.up * v.y + f.forward * v.z;
}
constexpr Vec3d to_world(const Frame& f, Vec3d p) {
  return f.origin + to_world_direction(f, p);
}

}  // namespace raygrain
