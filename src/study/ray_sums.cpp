#include "study/ray_sums.h"

#include "raygrain/analyze.h"

#include "geometry/same_bits.h"

namespace raygrain::study {
namespace {

RaySearch search(const Bvh& tree, const TriangleMesh& mesh, const Ray& ray, const CostModel& costs) {
  TraceCounters full, pruned;
  intersect(tree, mesh, ray, {}, {.prune = false}, &full);
  const Hit hit = intersect(tree, mesh, ray, {}, {}, &pruned);
  return {hit, ray_cost(full, costs), ray_cost(pruned, costs)};
}

}  // namespace

TreeTest exact_test(const SceneTrees& scene, const LocalTree& local, const AreaGeometry& geometry,
                    std::span<const Ray> rays, const CostModel& costs) {
  return {scene,
          local,
          geometry,
          rays,
          costs,
          [&scene, &local, costs](const Ray& ray) { return search(*local.tree, scene.mesh, ray, costs); },
          [&geometry](const Ray& ray) { return geometry.serves(ray); },
          [&geometry](const Ray& ray, const Hit& hit) { return hit.t <= exit_distance(geometry.region(), ray); }};
}

RaySums sum_rays(const TreeTest& test) {
  RaySums sums;
  sums.rays = test.rays.size();
  for (const Ray& ray : test.rays) {
    const RaySearch global = search(test.scene.global, test.scene.mesh, ray, test.costs);
    sums.global += global.full;
    sums.global_pruned += global.pruned;
    sums.hits += is_hit(global.hit) ? 1 : 0;
    bool accepted = false;
    if (test.serves(ray)) {
      const RaySearch local = test.search(ray);
      ++sums.served;
      sums.local += local.full;
      sums.local_pruned += local.pruned;
      sums.local_squares += local.full * local.full;
      accepted = is_hit(local.hit) && test.accepts(ray, local.hit);
      sums.mismatches += accepted && !same_bits(local.hit, global.hit) ? 1 : 0;
    }
    sums.accepted += accepted ? 1 : 0;
    if (accepted) continue;
    sums.miss += global.full;
    sums.miss_pruned += global.pruned;
  }
  return sums;
}

}  // namespace raygrain::study
