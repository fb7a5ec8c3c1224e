// Whole accelerators under verification: single rays, arrays, and batches that share a direction or a point.
#include <memory>

#include "raygrain/accelerator.h"

#include "verify/ask.h"

namespace raygrain::verification {

std::vector<InfluenceArea> accelerator_areas(const StructureSpec& spec, const VerifyScene& scene) {
  std::vector<InfluenceArea> areas;
  if (!spec.areas) return areas;
  const bool is_for_planes =
      spec.wide_measure == "DIR" || parse_recipe(spec.local, verify_registry(spec.seed)).measure == "DIR";
  for (const InfluenceArea& area : scene.areas)
    if (!is_for_planes || std::holds_alternative<PlaneArea>(area.shape)) areas.push_back(area);
  return areas;
}

AcceleratorOptions accelerator_options(const StructureSpec& spec) {
  AcceleratorOptions options;
  options.registry = verify_registry(spec.seed);
  options.local = parse_recipe(spec.local, options.registry);
  options.global = parse_recipe(spec.tree, options.registry);
  if (!spec.quality.empty()) options.quality = parse_quality(spec.quality);
  options.reinsert = spec.reinserted;
  options.reinsert_local = spec.reinserted_local;
  options.wide_measure = spec.wide_measure;
  options.traversal = spec.traversal == "binary" ? Traversal::kBinary : Traversal::kWide;
  options.space = !spec.local_trees ? LocalSpace::kNone : spec.ray_space ? LocalSpace::kRay : LocalSpace::kWorld;
  if (!spec.area_frame.empty()) options.frame = parse_frame(spec.area_frame);
  if (spec.solid_angle) options.density = RayDensity::kSolidAngle;
  options.isa = parse_isa(spec.isa);
  if (spec.seed % 2 == 0) options.routing = Routing::kAreas;  // else as sample rays say: often the global tree
  options.coverage = std::nullopt;
  if (spec.covered) options.coverage = CoverageOptions{spec.cells, spec.tile, {}, parse_order(spec.order)};
  options.top_level = {spec.octree ? TopLevelKind::kOctree : TopLevelKind::kList, 4};
  options.samples = [spec](const InfluenceArea* area) { return samples_of(spec, area); };
  options.threads = spec.threads;
  return options;
}

namespace {

void answer_rays(const StructureSpec& spec, const Accelerator& scene, const RayGroup& group,
                 const RayAnswers& answers) {
  AcceleratorCounters counters;
  AcceleratorCounters* counted = spec.counted ? &counters : nullptr;
  ask<Hit>(
      spec, group.rays, answers.nearest, [&](const Ray& ray) { return scene.intersect(ray, counted); },
      [&](std::span<const Ray> rays, std::span<Hit> hits) { scene.intersect(rays, hits, spec.threads, counted); });
  ask<uint8_t>(
      spec, group.rays, answers.any, [&](const Ray& ray) { return scene.occluded(ray, counted); },
      [&](std::span<const Ray> rays, std::span<uint8_t> flags) { scene.occluded(rays, flags, spec.threads, counted); });
  tell(answers, RayAnswers::kNearest | RayAnswers::kAny);
}

/// The calls for rays that share something, in pieces of the batch's size.
void answer_shared(const StructureSpec& spec, const Accelerator& scene, const RayGroup& group,
                   const RayAnswers& answers) {
  AcceleratorCounters counters;
  AcceleratorCounters* counted = spec.counted ? &counters : nullptr;
  std::vector<Vec3> parts;  // origins, or directions
  for (const Ray& ray : group.rays) parts.push_back(group.kind == RayGroupKind::kFrom ? ray.direction : ray.origin);
  for (size_t begin = 0; begin < parts.size(); begin += spec.batch) {
    const size_t count = std::min<size_t>(spec.batch, parts.size() - begin);
    const std::span<const Vec3> some = std::span<const Vec3>(parts).subspan(begin, count);
    const auto hits = answers.nearest.subspan(begin, count);
    const auto flags = answers.any.subspan(begin, count);
    if (group.kind == RayGroupKind::kFrom) scene.intersect_from(group.shared, some, hits, spec.threads, counted);
    if (group.kind == RayGroupKind::kTowards) scene.occluded_towards(some, group.shared, flags, spec.threads, counted);
    if (group.kind != RayGroupKind::kDirection) continue;
    scene.intersect(some, group.shared, hits, spec.threads, counted);
    scene.occluded(some, group.shared, flags, spec.threads, counted);
  }
  if (group.kind != RayGroupKind::kTowards) tell(answers, RayAnswers::kNearest | RayAnswers::kBatch);
  if (group.kind != RayGroupKind::kFrom) tell(answers, RayAnswers::kAny | RayAnswers::kBatch);
}

}  // namespace

AnswerRays make_accelerator(const StructureSpec& spec, const VerifyScene& scene) {
  const Accelerator accelerator(*scene.mesh, accelerator_areas(spec, scene), accelerator_options(spec));
  return [spec, accelerator](const RayGroup& group, const RayAnswers& answers) {
    if (group.kind == RayGroupKind::kMixed || spec.batch == 0) return answer_rays(spec, accelerator, group, answers);
    answer_shared(spec, accelerator, group, answers);
  };
}

}  // namespace raygrain::verification
