#include "raygrain/frame.h"

#include <cmath>

namespace raygrain {

namespace {

double largest_component(Vec3d v) {
  return std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z)));
}

// Scaled first, so that the squares of huge or tiny vectors neither overflow nor vanish. Zero stays zero.
Vec3d safe_normalized(Vec3d v) {
  const double largest = largest_component(v);
  return largest > 0 ? normalized(v / largest) : v;
}

Vec3d least_parallel_axis(Vec3d unit) {
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::fabs(unit[k]) < std::fabs(unit[axis])) axis = k;
  Vec3d result;
  result[axis] = 1;
  return result;
}

}  // namespace

Frame make_frame(Vec3d origin, Vec3d forward, Vec3d up) {
  constexpr double kParallelSine = 1e-6;
  Frame frame;
  frame.origin = origin;
  frame.forward = safe_normalized(forward);
  Vec3d right = cross(safe_normalized(up), frame.forward);
  if (!(length(right) > kParallelSine)) right = cross(least_parallel_axis(frame.forward), frame.forward);
  right = normalized(right);
  // A cross product of nearly parallel vectors keeps few digits: make it perpendicular once more.
  frame.right = normalized(right - frame.forward * dot(right, frame.forward));
  frame.up = normalized(cross(frame.forward, frame.right));
  return frame;
}

}  // namespace raygrain
