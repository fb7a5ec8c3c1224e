// Rays through the middles of pixels. A frame's `right` is x with y up and z *forward*: for someone who looks along
// the rays it points left. Pictures must not be mirrored, so their columns run against it.
#include <cmath>
#include <string>

#include "raygrain/error.h"
#include "raygrain/rays.h"

#include "base/trigonometry.h"

namespace raygrain {
namespace {

constexpr uint64_t kMostPixels = uint64_t{1} << 30;

void check_pixels(const std::string& where, uint32_t width, uint32_t height) {
  if (width == 0 || height == 0)
    throw Error(ErrorCode::kUsage, where, "width or height is 0", "Choose at least one pixel");
  if (uint64_t{width} * height > kMostPixels)
    throw Error(ErrorCode::kUsage, where, "too many pixels", "Choose at most 2^30 in all");
}

// Calls make(x, y) with the middle of each pixel of [-1, 1]^2, row by row from the viewer's top left.
template <class Make>
std::vector<Ray> make_grid(uint32_t width, uint32_t height, const Make& make) {
  std::vector<Ray> rays;
  rays.reserve(size_t{width} * height);
  for (uint32_t row = 0; row < height; ++row)
    for (uint32_t column = 0; column < width; ++column)
      rays.push_back(make(1 - (2.0 * column + 1) / width, 1 - (2.0 * row + 1) / height));
  return rays;
}

void check_camera(const CameraRays& camera) {
  const std::string where = "camera rays";
  check_pixels(where, camera.width, camera.height);
  if (!is_finite(camera.eye) || !is_finite(camera.target) || !is_finite(camera.up))
    throw Error(ErrorCode::kUsage, where, "eye, target or up is not finite");
  if (camera.eye == camera.target)
    throw Error(ErrorCode::kUsage, where, "eye and target are the same point", "Move the target to where to look");
  if (!(camera.fov_y > 0 && camera.fov_y < 180))
    throw Error(ErrorCode::kUsage, where, "fov_y is out of range", "Choose more than 0 and less than 180 degrees");
}

}  // namespace

std::vector<Ray> cast_rays(const CameraRays& camera) {
  check_camera(camera);
  const Vec3d eye = to_double(camera.eye);
  const Frame frame = make_frame(eye, to_double(camera.target) - eye, to_double(camera.up));
  const double half_y = tangent(radians(camera.fov_y) / 2), half_x = half_y * camera.width / camera.height;
  return make_grid(camera.width, camera.height, [&](double x, double y) -> Ray {
    return {camera.eye, to_float(normalized(to_world_direction(frame, {x * half_x, y * half_y, 1})))};
  });
}

std::vector<Ray> window_grid_rays(const InfluenceArea& area, uint32_t width, uint32_t height) {
  check_pixels("picture of area \"" + area.name + '"', width, height);
  const AreaGeometry geometry(area);
  const Frame& frame = geometry.frame();
  const Vec2d half = geometry.window_half();
  const auto* point = std::get_if<PointArea>(&area.shape);
  return make_grid(width, height, [&](double x, double y) -> Ray {
    const Vec3d window{x * half.x, y * half.y, 0};
    if (!point) return {to_float(to_world(frame, window)), to_float(frame.forward)};
    const Vec3d through = to_world_direction(frame, window + Vec3d{0, 0, 1});
    return {to_float(frame.origin + through * point->near_z), to_float(normalized(through))};
  });
}

}  // namespace raygrain
