// Binary and wide trees under verification.
#include <memory>

#include "raygrain/trace.h"
#include "raygrain/wide.h"

#include "verify/ask.h"

namespace raygrain::verification {

AnswerRays make_binary(const StructureSpec& spec, const VerifyScene& scene) {
  const auto tree = std::make_shared<const Bvh>(make_tree(spec, scene));
  return [spec, tree, mesh = scene.mesh](const RayGroup& group, const RayAnswers& answers) {
    const SearchOptions how{.prune = !spec.unpruned};
    TraceCounters counters;
    TraceCounters* counted = spec.counted ? &counters : nullptr;
    for (size_t i = 0; i < group.rays.size(); ++i) {
      answers.nearest[i] = intersect(*tree, *mesh, group.rays[i], {}, how, counted);
      answers.any[i] = occluded(*tree, *mesh, group.rays[i], how, counted);
    }
    tell(answers, RayAnswers::kNearest | RayAnswers::kAny);
  };
}

AnswerRays make_wide(const StructureSpec& spec, const VerifyScene& scene) {
  const WideBvh tree(make_tree(spec, scene), *scene.mesh,
                     {.measure = wide_measure(spec, scene), .isa = parse_isa(spec.isa), .max_leaf_size = spec.leaf});
  return [spec, tree](const RayGroup& group, const RayAnswers& answers) {
    const SearchOptions how{.prune = !spec.unpruned};
    TraceCounters counters;
    ask<Hit>(
        spec, group.rays, answers.nearest,
        [&](const Ray& ray) {
          return spec.counted ? tree.intersect_counted(ray, counters, {}, how) : tree.intersect(ray, {}, how);
        },
        [&](std::span<const Ray> rays, std::span<Hit> hits) { tree.intersect(rays, hits, spec.threads); });
    ask<uint8_t>(
        spec, group.rays, answers.any,
        [&](const Ray& ray) {
          return spec.counted ? tree.occluded_counted(ray, counters, how) : tree.occluded(ray, how);
        },
        [&](std::span<const Ray> rays, std::span<uint8_t> flags) { tree.occluded(rays, flags, spec.threads); });
    tell(answers, RayAnswers::kNearest | RayAnswers::kAny);
  };
}

}  // namespace raygrain::verification
