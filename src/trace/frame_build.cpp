// From triangles to a tree in ray space.
#include <algorithm>
#include <cmath>
#include <vector>

#include "raygrain/error.h"
#include "raygrain/frame_tree.h"

#include "base/parallel.h"
#include "base/sizes.h"
#include "build/estimate.h"
#include "trace/frame_density.h"

namespace raygrain {
namespace {

Bounds bounds_of(const RayFrame& frame, const std::array<Vec3, 3>& corners, const Bounds& box) {
  return frame_bounds(frame, corners[0], corners[1], corners[2], box);
}

struct FramePrimitives {
  std::vector<uint32_t> ids;
  std::vector<Bounds> bounds;
  std::vector<Vec3> centers;
};

FramePrimitives primitives_in(const RayFrame& frame, const TriangleCorners& corners,
                              std::span<const uint32_t> triangles, unsigned threads) {
  std::vector<Bounds> all(triangles.size());
  parallel_for(triangles.size(), 1024, threads, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) all[i] = bounds_of(frame, corners.at_id(triangles[i]), frame.domain);
  });
  FramePrimitives result;
  for (size_t i = 0; i < triangles.size(); ++i) {
    if (is_empty(all[i])) continue;
    result.ids.push_back(triangles[i]);
    result.bounds.push_back(all[i]);
    result.centers.push_back(center(all[i]));
  }
  return result;
}

/// The weights with the z term: in the frame, depths and widths have different units.
Vec3 weights_of(const FrameBuildOptions& options, const Bounds& scene) {
  const Vec3 size = extent(scene);
  const double across = std::sqrt(static_cast<double>(size.x) * static_cast<double>(size.y));
  const double term = size.z > 0 ? static_cast<double>(options.z_term) * across / static_cast<double>(size.z) : 0;
  const Vec3d w = options.weights / options.weights.z;
  const Vec3 weights = to_float(Vec3d{w.x + term, w.y + term, 1});
  if (!is_finite(weights))
    throw Error(ErrorCode::kUsage, "FrameBuildOptions", "the weights' relation to weights.z is beyond float");
  return weights;
}

constexpr uint32_t kMostFrameTriangles = 16;  // in a leaf

RayMeasure measure_of(const FrameBuildOptions& options, const Bounds& scene) {
  const Vec3 weights = weights_of(options, scene);
  return options.density == RayDensity::kSolidAngle ? solid_face_measure(weights) : face_weight_measure(weights);
}

void check_options(const FrameBuildOptions& options, const RayFrame& frame) {
  const auto is_good = [](double term) { return term >= 0 && std::isfinite(term); };
  const auto [x, y, z] = options.weights;
  if (!(is_good(x) && is_good(y) && is_good(z) && z > 0 && is_good(static_cast<double>(options.z_term))))
    throw Error(ErrorCode::kUsage, "FrameBuildOptions",
                "weights and z_term must be finite and not negative, weights.z not zero");
  if (options.density == RayDensity::kSolidAngle && !frame.is_projective())
    throw Error(ErrorCode::kUsage, "FrameBuildOptions",
                "solid angles are about rays through a point, and those of this frame are parallel",
                "Take RayDensity::kNearPlane");
}

bool fits_floats(const Bounds& scene) {
  constexpr float kLeast = 0x1p-30f, kGreatest = 0x1p30f;
  const auto size = [&](int axis) { return std::max(std::abs(scene.lo[axis]), std::abs(scene.hi[axis])); };
  const float width = std::max(size(0), size(1)), depth = size(2);
  return width >= kLeast && width <= kGreatest && depth >= kLeast && depth <= kGreatest;
}

}  // namespace

std::optional<FrameTree> build_frame_tree(const RayFrame& frame, std::shared_ptr<const TriangleCorners> corners,
                                          std::span<const uint32_t> triangles, const FrameBuildOptions& options,
                                          double* cost) {
  if (corners == nullptr) throw Error(ErrorCode::kUsage, "build_frame_tree", "has no corners");
  check_numbers("build_frame_tree", triangles, corners->size(), "triangles");
  check_options(options, frame);
  FramePrimitives primitives = primitives_in(frame, *corners, triangles, options.threads);
  Bounds scene;
  for (const Bounds& box : primitives.bounds) scene.extend(box.lo), scene.extend(box.hi);
  if (primitives.ids.empty()) return FrameTree(frame, {}, std::move(corners), {.isa = options.isa});
  if (!fits_floats(scene)) return {};

  BuildOptions build;
  build.strategy.measure = measure_of(options, scene);
  build.parameters.bins = 32;
  build.parameters.max_levels = 64;
  build.threads = options.threads;
  build.clip = [&](uint32_t i, const Bounds& box) { return bounds_of(frame, corners->at_id(primitives.ids[i]), box); };
  Bvh tree = options.spatial ? build_spatial(primitives.bounds, primitives.centers, build)
                             : build_binned(primitives.bounds, primitives.centers, build);
  for (uint32_t& primitive : tree.prims) primitive = primitives.ids[primitive];
  if (cost != nullptr)
    *cost = estimated_cost(tree, build.strategy.measure, build.costs) *
            static_cast<double>(build.strategy.measure(tree.nodes[0].bounds)) * options.weights.z;
  return FrameTree(frame, tree, std::move(corners),
                   {.measure = build.strategy.measure,
                    .isa = options.isa,
                    .max_leaf_size = kMostFrameTriangles,
                    .threads = options.threads});
}

}  // namespace raygrain
