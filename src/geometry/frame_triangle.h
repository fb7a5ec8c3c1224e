// A triangle in ray space as filters see it: three edges and a plane, linear in x and y.
#pragma once

#include <array>

#include "raygrain/ray_frame.h"

namespace raygrain {

/// For |x|, |y| <= reach. Edge functions a x + b y + c have |a| + |b| = 1, or a = b = 0; they are wrong by at most
/// kEdgeError reach. At every point of the triangle's image in `box` all three are at least minus that, and z is within
/// z_error of p x + q y + r. Where all three exceed it, a line along z meets the inside of the triangle (before the
/// eye), once, there. docs/theory-frames.md, section "Triangles".
struct FrameTriangle {
  struct Edge {
    double a = 0, b = 0, c = 0;
  };
  std::array<Edge, 3> edges;  // 0, 0, 0: not known well enough, or no orientation; all where the plane is too steep
  double p = 0, q = 0, r = 0, z_error = 0;
};
inline constexpr double kEdgeError = 0x1p-22;

/// `box` holds the part of the image that counts (frame_bounds), not empty.
FrameTriangle frame_triangle(const RayFrame& frame, Vec3 a, Vec3 b, Vec3 c, const Bounds& box, double reach);

}  // namespace raygrain
