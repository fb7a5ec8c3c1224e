#include "trace/frame_density.h"

#include <algorithm>
#include <array>
#include <limits>

#include "geometry/solid_angle.h"

namespace raygrain {
namespace {

double xy_solid_angle(Vec3d lo, Vec3d hi) {
  const std::array<Vec2d, 4> corners{{{lo.x, lo.y}, {hi.x, lo.y}, {hi.x, hi.y}, {lo.x, hi.y}}};
  return solid_angle(corners);
}

struct SolidFaces {
  Vec3d weights;

  float operator()(const Bounds& box) const {
    const Vec3d lo = to_double(box.lo), hi = to_double(box.hi), edge = hi - lo;
    const double sides = weights.x * (edge.y * edge.z) + weights.y * (edge.z * edge.x);
    const double all = sides + weights.z * xy_solid_angle(lo, hi);
    return static_cast<float>(std::min(all, static_cast<double>(std::numeric_limits<float>::max())));
  }
};

}  // namespace

RayMeasure solid_face_measure(Vec3 weights) {
  return {SolidFaces{to_double(weights)}};
}

}  // namespace raygrain
