// Trees in ray space under verification: columns and cones.
#include <algorithm>
#include <memory>
#include <numeric>

#include "raygrain/frame_tree.h"

#include "verify/ask.h"

namespace raygrain::verification {
namespace {

/// A tree, and how far its answers reach.
struct FrameUnderTest {
  FrameTree tree;
  std::optional<AreaGeometry> area;  // hits count in its region only

  /// Negative: not this tree's ray.
  float reach(const Ray& ray) const {
    if (!area) return kInf;
    if (!is_valid(ray) || !(ray.tmin >= 0) || !contains(area->region(), ray.origin)) return -1;
    return exit_distance(area->region(), ray);
  }
};

std::optional<FrameUnderTest> make_frame_tree(const StructureSpec& spec, const VerifyScene& scene) {
  const InfluenceArea* area = area_of(spec, scene);
  if (area == nullptr) return {};
  const AreaGeometry geometry(*area);
  const FrameKind kind = parse_frame(spec.frame);
  const Bounds box = mesh_bounds(*scene.mesh);
  const Vec3 direction = to_float(normalized(geometry.ray_direction(geometry.region().corners[0])));
  const std::optional<RayFrame> frame =
      spec.of_area ? area_frame(kind, geometry) : parallel_frame(kind, direction, is_empty(box) ? Vec3{} : center(box));
  if (!frame) return {};
  std::vector<uint32_t> ids(scene.mesh->triangle_count());
  std::iota(ids.begin(), ids.end(), 0u);
  const auto tree = build_frame_tree(
      *frame, std::make_shared<const TriangleCorners>(*scene.mesh), ids,
      {.weights = spec.of_area ? frame_area_weights(*frame, geometry) : Vec3d{0, 0, 1},
       .z_term = spec.seed % 3 == 0 ? 0.0f : 0.1f,
       .density = frame->is_projective() && spec.solid_angle ? RayDensity::kSolidAngle : RayDensity::kNearPlane,
       .spatial = spec.spatial,
       .threads = 1,
       .isa = parse_isa(spec.isa)});
  if (!tree) return {};
  return FrameUnderTest{*tree, spec.of_area ? std::optional(geometry) : std::nullopt};
}

}  // namespace

AnswerRays make_frame(const StructureSpec& spec, const VerifyScene& scene) {
  const auto under_test = make_frame_tree(spec, scene);
  if (!under_test) return {};
  return [spec, under_test = *under_test](const RayGroup& group, const RayAnswers& answers) {
    const SearchOptions how{.prune = !spec.unpruned};
    TraceCounters counters;
    for (size_t i = 0; i < group.rays.size(); ++i) {
      Ray ray = group.rays[i];
      const float reach = under_test.reach(ray);
      if (reach < 0) continue;
      ray.tmax = std::min(ray.tmax, reach);
      const FrameTree& tree = under_test.tree;
      const auto hit = spec.counted ? tree.intersect_counted(ray, counters, {}, how) : tree.intersect(ray, {}, how);
      const auto any = spec.counted ? tree.occluded_counted(ray, counters, how) : tree.occluded(ray, how);
      if (hit) answers.nearest[i] = *hit;
      if (any) answers.any[i] = *any;
      const FrameUse use = tree.use_of(ray);
      answers.told[i] = static_cast<uint8_t>((hit ? RayAnswers::kNearest : 0) | (any ? RayAnswers::kAny : 0) |
                                             (use == FrameUse::kColumn ? RayAnswers::kColumn : 0) |
                                             (use == FrameUse::kCone ? RayAnswers::kCone : 0));
      answers.until[i] = reach;
    }
  };
}

}  // namespace raygrain::verification
