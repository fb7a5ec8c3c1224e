// The study `stress`: all areas of a scene at once, and more and more rays that belong to none.
#include <array>

#include <fmt/format.h>

#include "raygrain/analyze.h"

#include "base/random.h"
#include "base/timer.h"
#include "geometry/same_bits.h"
#include "study/presets.h"
#include "study/scene_pool.h"
#include "study/sources.h"

namespace raygrain::study {
namespace {

constexpr int kTimedPasses = 3;
constexpr std::array kForeignShares{0.0, 0.25, 0.5, 0.75, 1.0};

const std::vector<StudyColumn>& columns() {
  static const std::vector<StudyColumn> all{
      {"areas"},           {"foreign_share"},      {"pruned_cost_with_fallback"}, {"global_pruned_cost"},
      {"local_miss_cost"}, {"local_hit_ratio"},    {"break_even_hit_ratio"},      {"areas_tested"},
      {"local_searches"},  {"continued"},          {"global_searches"},           {"rays"},
      {"mismatches"},      {"ray_seconds", false}, {"global_ray_seconds", false}};
  return all;
}

/// All areas of a scene with their trees of one recipe.
struct Everything {
  std::once_flag once;
  std::shared_ptr<const TriangleMesh> mesh;
  std::shared_ptr<const Bvh> global;
  std::unique_ptr<const Accelerator> accelerator;

  void make(const SceneTrees& scene, const std::vector<StudyArea>& areas, const Recipe& recipe) {
    mesh = std::make_shared<const TriangleMesh>(scene.mesh);
    global = std::make_shared<const Bvh>(scene.global);
    std::vector<LocalTree> locals;
    locals.reserve(areas.size());
    for (const StudyArea& area : areas)
      locals.push_back(build_local_tree(*mesh, area.area, recipe, default_registry()));
    accelerator =
        std::make_unique<const Accelerator>(mesh, std::move(locals), global, TopLevelOptions{}, Traversal::kBinary);
  }
};

/// From anywhere in the scene's box to anywhere else in it.
Ray foreign_ray(Random& random, const Bounds& box) {
  Ray ray;
  for (int axis = 0; axis < 3; ++axis) {
    const double lo = static_cast<double>(box.lo[axis]), hi = static_cast<double>(box.hi[axis]);
    const double from = random.uniform(lo, hi), to = random.uniform(lo, hi);
    ray.origin[axis] = static_cast<float>(from);
    ray.direction[axis] = static_cast<float>(to - from);
  }
  return ray;
}

std::vector<Ray> mixed_rays(const TriangleMesh& mesh, std::span<const LocalTree> locals, double foreign, size_t count,
                            uint64_t seed) {
  const auto strangers = static_cast<size_t>(foreign * static_cast<double>(count));
  std::vector<Ray> rays;
  for (size_t i = 0; i < locals.size(); ++i) {
    const size_t part = (count - strangers) * (i + 1) / locals.size() - (count - strangers) * i / locals.size();
    const std::vector<Ray> cast = cast_rays(AreaRays{.area = locals[i].area}, part, seed);
    rays.insert(rays.end(), cast.begin(), cast.end());
  }
  Random random(seed);
  const Bounds box = mesh_bounds(mesh);
  while (rays.size() < count) rays.push_back(foreign_ray(random, box));
  return rays;
}

template <class Find>
double seconds_per_ray(std::span<const Ray> rays, const Find& find) {
  double least = kInf;
  for (int pass = 0; pass < kTimedPasses; ++pass) {
    const Timer timer;
    for (const Ray& ray : rays) find(ray);
    least = std::min(least, timer.seconds());
  }
  return least / static_cast<double>(rays.size());
}

std::vector<std::string> run_row(const Everything& all, double foreign, size_t count, uint64_t seed) {
  const Accelerator& accelerator = *all.accelerator;
  const std::vector<Ray> rays = mixed_rays(*all.mesh, accelerator.local_trees(), foreign, count, seed);
  AcceleratorCounters counters;
  TraceCounters alone, misses;
  size_t mismatches = 0, missed = 0;
  for (const Ray& ray : rays) {
    AcceleratorCounters own;
    const Hit hit = accelerator.intersect(ray, &own);
    TraceCounters global;
    mismatches += same_bits(hit, intersect(*all.global, *all.mesh, ray, {}, {}, &global)) ? 0 : 1;
    alone.add(global);
    if (own.global_searches > 0) {
      misses.add(global);
      ++missed;
    }
    counters.add(own);
  }
  const double n = static_cast<double>(rays.size());
  const double local = ray_cost(counters.local, {}) / n, global = ray_cost(alone, {}) / n;
  const double miss = missed > 0 ? ray_cost(misses, {}) / static_cast<double>(missed) : 0;
  const auto per_ray = [n](uint64_t value) { return static_cast<double>(value) / n; };
  Cells cells(columns());
  cells.set("areas", static_cast<double>(accelerator.local_trees().size()));
  cells.set("foreign_share", foreign);
  cells.set("pruned_cost_with_fallback", local + ray_cost(counters.global, {}) / n);
  cells.set("global_pruned_cost", global);
  cells.set("local_miss_cost", miss);
  cells.set("local_hit_ratio", per_ray(counters.local_hits));
  cells.set("break_even_hit_ratio", break_even_hit_ratio(local, miss, global));
  cells.set("areas_tested", per_ray(counters.areas_tested));
  cells.set("local_searches", per_ray(counters.local_searches));
  cells.set("continued", per_ray(counters.continued));
  cells.set("global_searches", per_ray(counters.global_searches));
  cells.set("rays", n);
  cells.set("mismatches", static_cast<double>(mismatches));
  cells.set("ray_seconds", seconds_per_ray(rays, [&](const Ray& ray) { accelerator.intersect(ray); }));
  cells.set("global_ray_seconds",
            seconds_per_ray(rays, [&](const Ray& ray) { intersect(*all.global, *all.mesh, ray); }));
  return cells.take();
}

}  // namespace

Study stress_study(const StudySources& sources) {
  Study study{"stress", columns(), {}, "rays " + std::to_string(sources.rays), {}};
  const Registry registry = default_registry();
  const std::vector<StudyScene> scenes = paper_scenes(sources, study.missing);
  study.identity += contents_of(scenes);
  for (const StudyScene& scene : scenes) {
    const auto trees = std::make_shared<LazyScene>([load = scene.load] {
      TriangleMesh mesh = load();
      Bvh global = build_global_tree(mesh, {"SAH", "ALL", "binned", {}}, default_registry());
      return make_scene_trees(std::move(mesh), std::move(global));
    });
    for (const char* combo : {"SAH+ALL@binned", "PAH+ALL@binned"}) {
      const auto all = std::make_shared<Everything>();
      const Recipe recipe = parse_recipe(combo, registry);
      for (const double foreign : kForeignShares)
        study.add(
            {scene.name, "", fmt::format("foreign {:.2f}", foreign), combo, "", "mixed", sources.seed},
            [=, areas = scene.areas, rays = sources.rays, seed = sources.seed] {
              std::call_once(all->once, [&] { all->make(trees->get(), areas, recipe); });
              return run_row(*all, foreign, rays, seed);
            },
            scene.weight);
    }
  }
  return study;
}

}  // namespace raygrain::study
