// Which frame an area's rays are best seen in.
#include <algorithm>
#include <limits>

#include "accel/build_trees.h"
#include "base/random.h"

namespace raygrain {

namespace {

/// Triangles that frames are compared on: an eighth of all, but neither fewer nor more than so many.
constexpr size_t kLeastSubset = 8192, kMostSubset = 32768;

/// What rays of the area the measure is made for: the samples, or those within the area's tolerance.
Vec3d weights_for(const RayFrame& frame, const AreaGeometry& area, std::span<const Ray> samples) {
  std::vector<Vec3> directions;
  for (const Ray& ray : samples)
    if (is_valid(ray)) directions.push_back(ray.direction);
  if (directions.empty()) return frame_area_weights(frame, area);
  return frame.is_projective() ? frame_slope_weights(frame, samples) : frame_face_weights(frame, directions);
}

/// One from each of as many equal stretches, drawn at random: in order they could be one of the two triangles of every
/// square of a grid. Few triangles are no judge: the gaps between them hide how much thinner boxes are in one frame
/// than in another.
std::vector<uint32_t> subset_of(std::span<const uint32_t> triangles) {
  const size_t count = std::clamp(triangles.size() / 8, kLeastSubset, kMostSubset);
  if (triangles.size() <= count) return {triangles.begin(), triangles.end()};
  Random random(1);
  std::vector<uint32_t> subset;
  for (size_t i = 0; i < count; ++i) {
    const size_t begin = i * triangles.size() / count, end = (i + 1) * triangles.size() / count;
    subset.push_back(triangles[begin + random.below(end - begin)]);
  }
  return subset;
}

/// Builds an area's trees over some of the triangles, in any of its frames.
struct FrameTrees {
  const AreaGeometry& area;
  const std::shared_ptr<const TriangleCorners>& corners;
  std::span<const Ray> samples;
  FrameBuildOptions options;

  std::optional<FrameTree> build(FrameKind kind, std::span<const uint32_t> triangles, double* cost = nullptr) const {
    const RayFrame frame = *area_frame(kind, area);
    FrameBuildOptions weighted = options;
    weighted.weights = weights_for(frame, area, samples);
    if (!frame.is_projective()) weighted.density = RayDensity::kNearPlane;
    return build_frame_tree(frame, corners, triangles, weighted, cost);
  }
};

FrameKind cheapest(const FrameTrees& trees, std::span<const FrameKind> kinds, std::span<const uint32_t> triangles) {
  if (kinds.size() == 1) return kinds.front();
  const std::vector<uint32_t> subset = subset_of(triangles);
  FrameKind best = kinds.front();
  double least = std::numeric_limits<double>::infinity();
  for (const FrameKind kind : kinds) {
    double cost = std::numeric_limits<double>::infinity();
    trees.build(kind, subset, &cost);
    if (cost < least) best = kind;
    least = std::min(least, cost);
  }
  return best;
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
  const FrameTrees trees{
      geometry, corners, samples, {.density = options.density, .threads = options.threads, .isa = options.isa}};
  return trees.build(cheapest(trees, kinds, triangles), triangles);
}

}  // namespace raygrain
