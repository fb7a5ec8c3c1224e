// The image of a triangle in a ray frame, with the error of its computation.
#pragma once

#include <array>

#include "raygrain/ray_frame.h"

namespace raygrain {

double largest_component(Vec3d v);

/// rows . (p - center), wrong by at most 5u norm |p - center|, u = 2^-53, in each coordinate.
Vec3d to_local(const RayFrame& frame, Vec3d point);

struct FramePolygon {
  std::array<Vec3d, 10> corners;
  size_t count = 0;
  Vec3d padding;            // the true image's points are within it of the polygon, in each coordinate
  bool is_unknown = false;  // the image may be anywhere in the domain

  void push(Vec3d p) {
    if (count < corners.size()) corners[count++] = p;
  }
};

/// Of the whole triangle; of the part with z >= near_z for projective frames (empty where nothing is there).
FramePolygon frame_polygon(const RayFrame& frame, Vec3 a, Vec3 b, Vec3 c);

}  // namespace raygrain
