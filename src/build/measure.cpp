#include "raygrain/measure.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace raygrain {

namespace {

/// Double inside, so that only areas beyond float's range lose their order: they saturate instead of becoming infinite,
/// which builders refuse.
struct FaceWeights {
  Vec3d weights;

  float operator()(const Bounds& box) const {
    const Vec3d edge = to_double(box.hi) - to_double(box.lo);
    const double area = weights.x * (edge.y * edge.z) + weights.y * (edge.z * edge.x) + weights.z * (edge.x * edge.y);
    return static_cast<float>(std::min(area, static_cast<double>(std::numeric_limits<float>::max())));
  }
};

}  // namespace

RayMeasure::RayMeasure() : RayMeasure(FaceWeights{{0.5, 0.5, 0.5}}) {}

RayMeasure RayMeasure::from_batch(Batch batch, std::optional<float> total) {
  RayMeasure measure;
  measure.batch_ = std::move(batch);
  measure.total_ = total;
  return measure;
}

RayMeasure face_weight_measure(Vec3 weights, std::optional<float> total) {
  return {FaceWeights{to_double(weights)}, total};
}

}  // namespace raygrain
