#include <algorithm>
#include <limits>
#include <memory>

#include "raygrain/error.h"
#include "raygrain/heuristics.h"

namespace raygrain {

namespace {

// A measure must be finite, and a double above the range of float has no conversion.
float to_measure(double area) {
  return static_cast<float>(std::min(area, static_cast<double>(std::numeric_limits<float>::max())));
}

}  // namespace

RayMeasure surface_area_measure() {
  return face_weight_measure();
}

RayMeasure directional_measure(Vec3 direction) {
  if (!is_finite(direction) || direction == Vec3{})
    throw Error(ErrorCode::kBadArea, "direction", "zero or not finite", "give the direction in which the rays travel");
  return face_weight_measure(to_float(parallel_face_weights(make_frame({}, to_double(direction), {}).forward)));
}

RayMeasure projected_area_measure(const InfluenceArea& area, Culling culling) {
  const auto geometry = std::make_shared<const AreaGeometry>(area);
  std::optional<float> total;
  if (culling == Culling::kWindow) total = to_measure(geometry->window_area());
  return RayMeasure(
      [geometry, culling](const Bounds& box) { return to_measure(geometry->projected_area(box, culling)); }, total);
}

RayMeasure solid_angle_measure(const InfluenceArea& area, Culling culling) {
  const auto geometry = std::make_shared<const AreaGeometry>(area);
  if (geometry->is_plane()) return projected_area_measure(area, culling);
  if (culling == Culling::kNone)
    return {[geometry](const Bounds& box) { return static_cast<float>(geometry->solid_angle(box, Culling::kNone)); }};
  const double total = geometry->window_solid_angle();
  return RayMeasure(
      [geometry, total](const Bounds& box) {
        return static_cast<float>(std::min(geometry->solid_angle(box, Culling::kWindow), total));
      },
      static_cast<float>(total));
}

}  // namespace raygrain
