// Which frame an area's rays are best seen in.
#include <algorithm>
#include <limits>

#include "accel/build_trees.h"

namespace raygrain {

namespace {

constexpr size_t kSubset = 8192;  // triangles that frames are compared on

/// What rays of the area the measure is made for.
Vec3d weights_for(const RayFrame& frame, const AreaGeometry& area, std::span<const Ray> samples) {
  if (frame.is_projective()) return frame_slope_weights(frame, samples);
  std::vector<Vec3> directions;
  for (const Ray& ray : samples)
    if (is_valid(ray)) directions.push_back(ray.direction);
  if (directions.empty()) directions.push_back(to_float(area.frame().forward));
  return frame_face_weights(frame, directions);
}

std::vector<uint32_t> subset_of(std::span<const uint32_t> triangles) {
  const size_t step = std::max<size_t>(1, triangles.size() / kSubset);
  std::vector<uint32_t> subset;
  for (size_t i = 0; i < triangles.size(); i += step) subset.push_back(triangles[i]);
  return subset;
}

}  // namespace

std::optional<FrameTree> build_area_frame_tree(const InfluenceArea& area,
                                               const std::shared_ptr<const TriangleCorners>& corners,
                                               std::span<const uint32_t> triangles, std::span<const Ray> samples,
                                               const AcceleratorOptions& options) {
  const AreaGeometry geometry(area);
  std::vector<FrameKind> kinds = frame_kinds(geometry);
  if (options.frame && std::ranges::count(kinds, *options.frame) != 0) kinds = {*options.frame};
  if (kinds.empty()) return {};
  FrameBuildOptions build;
  build.threads = options.threads;
  build.isa = options.isa;
  const auto build_in = [&](FrameKind kind, std::span<const uint32_t> some, double* cost) {
    const RayFrame frame = *area_frame(kind, geometry);
    build.weights = weights_for(frame, geometry, samples);
    return build_frame_tree(frame, corners, some, build, cost);
  };
  FrameKind best = kinds.front();
  if (kinds.size() > 1) {
    const std::vector<uint32_t> subset = subset_of(triangles);
    double least = std::numeric_limits<double>::infinity();
    for (const FrameKind kind : kinds) {
      double cost = std::numeric_limits<double>::infinity();
      build_in(kind, subset, &cost);
      if (cost < least) best = kind;
      least = std::min(least, cost);
    }
  }
  return build_in(best, triangles, nullptr);
}

}  // namespace raygrain
