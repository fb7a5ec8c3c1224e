// Face weights of measures in ray space. docs/theory-frames.md, section "Measures", has the proofs.
#include <cmath>
#include <limits>

#include "raygrain/error.h"
#include "raygrain/ray_frame.h"

#include "geometry/cone_directions.h"

namespace raygrain {
namespace {

constexpr size_t kDirections = 256;  // of a cone

Vec3d plane_area_weights(const RayFrame& frame, const AreaGeometry& area) {
  const double tolerance = area.area().tolerance;
  std::vector<Vec3> directions{to_float(area.frame().forward)};
  if (tolerance > 0) directions.resize(kDirections);
  for (size_t i = 0; i < directions.size() && tolerance > 0; ++i)
    directions[i] = to_float(cone_direction(area.frame(), tolerance, i, kDirections));
  return frame_face_weights(frame, directions);
}

/// Rays from the near plane, evenly over the window (Roberts' sequence), each in the cone around its own direction.
Vec3d point_area_weights(const AreaGeometry& area) {
  constexpr double kAcross = 0.7548776662466927, kUp = 0.5698402909980532, kFlattest = 0x1p-10;
  const Vec2d half = area.window_half();
  const double tolerance = area.area().tolerance, near = std::get<PointArea>(area.area().shape).near_z;
  Vec3d sum;
  for (size_t i = 0; i < kDirections && tolerance > 0; ++i) {
    const double turn = static_cast<double>(i) + 0.5, across = kAcross * turn, up = kUp * turn;
    const Vec3d at{half.x * (2 * (across - std::floor(across)) - 1), half.y * (2 * (up - std::floor(up)) - 1), 1};
    const Vec3d along = cone_direction(make_frame({}, at, {0, 1, 0}), tolerance, i, kDirections);
    if (along.z < kFlattest) continue;  // it leaves the region where it starts
    sum = sum + Vec3d{near * std::abs(along.x / along.z - at.x), near * std::abs(along.y / along.z - at.y), 1};
  }
  return sum.z > 0 ? sum / sum.z : Vec3d{0, 0, 1};
}

}  // namespace

Vec3d frame_face_weights(const RayFrame& frame, std::span<const Vec3> directions) {
  if (frame.is_projective() || directions.empty())
    throw Error(ErrorCode::kUsage, "frame_face_weights",
                directions.empty() ? "there are no directions" : "a projective frame has no face weights",
                directions.empty() ? "" : "Use frame_slope_weights");
  Vec3d sum;
  for (const Vec3 direction : directions) {
    if (direction == Vec3{} || !is_finite(direction))
      throw Error(ErrorCode::kUsage, "frame_face_weights", "a direction is zero or not finite");
    const Vec3d v = normalized(to_double(direction));
    for (size_t k = 0; k < 3; ++k) sum[static_cast<int>(k)] += std::abs(dot(frame.rows[k], v));
  }
  const double determinant = std::abs(dot(frame.rows[0], cross(frame.rows[1], frame.rows[2])));
  return sum / (static_cast<double>(directions.size()) * determinant);
}

Vec3d frame_slope_weights(const RayFrame& frame, std::span<const Ray> rays) {
  Vec3d sum;
  double count = 0;
  constexpr float kMost = std::numeric_limits<float>::max();
  for (const Ray& ray : rays) {
    FrameSegment s;
    if (!is_valid(ray)) continue;
    if (make_segment(frame, ray, {-kMost, kMost}, s) != FrameFit::kServed) continue;
    sum = sum + Vec3d{std::abs(s.slope_x), std::abs(s.slope_y), 0};
    ++count;
  }
  return count > 0 ? Vec3d{sum.x / count, sum.y / count, 1} : Vec3d{0, 0, 1};
}

Vec3d frame_area_weights(const RayFrame& frame, const AreaGeometry& area) {
  if (frame.is_projective() == area.is_plane())
    throw Error(ErrorCode::kUsage, "frame_area_weights", "the frame is of another kind of area", "Use area_frame");
  return frame.is_projective() ? point_area_weights(area) : plane_area_weights(frame, area);
}

}  // namespace raygrain
