// The study `areas`: octree against list for 1 to 256 areas.
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "raygrain/analyze.h"

#include "base/random.h"
#include "base/timer.h"
#include "study/presets.h"
#include "study/scene_pool.h"
#include "study/sources.h"

namespace raygrain::study {
namespace {

constexpr size_t kQueries = 20000;
constexpr int kTimedPasses = 3;

const std::vector<StudyColumn>& columns() {
  static const std::vector<StudyColumn> all{{"areas"},
                                            {"top_level"},
                                            {"top_level_max_level"},
                                            {"top_level_nodes"},
                                            {"top_level_leaves"},
                                            {"top_level_areas_per_leaf"},
                                            {"top_level_false_candidates"},
                                            {"top_level_memory_bytes"},
                                            {"top_level_paper_memory_bytes"},
                                            {"areas_tested"},
                                            {"pruned_cost_with_fallback"},
                                            {"global_pruned_cost"},
                                            {"local_hit_ratio"},
                                            {"mismatches"},
                                            {"rays"},
                                            {"top_level_build_seconds", false},
                                            {"top_level_query_seconds", false},
                                            {"ray_seconds", false}};
  return all;
}

Vec3 point_in(Random& random, const Bounds& box) {
  Vec3 p;
  for (int axis = 0; axis < 3; ++axis)
    p[axis] = static_cast<float>(random.uniform(static_cast<double>(box.lo[axis]), static_cast<double>(box.hi[axis])));
  return p;
}

/// Plane and point areas in turn, anywhere in the scene, in any direction, each some tenth of its size.
std::vector<InfluenceArea> scatter(const Bounds& box, size_t count, uint64_t seed) {
  const float size = length(extent(box)) * 0.1f;
  Random random(seed);
  std::vector<InfluenceArea> areas;
  for (size_t i = 0; i < count; ++i) {
    const Vec3 at = point_in(random, box);
    const Vec3 along = point_in(random, {{-1, -1, -1}, {1, 1, 1}});
    const std::string name = std::to_string(i + 1);
    if (i % 2 == 0)
      areas.push_back({name, PlaneArea{at, along, {0, 1, 0}, size / 2, size / 2, size * 2}});
    else
      areas.push_back({name, PointArea{at, along, {0, 1, 0}, 60, 60, size * 0.1f, size * 2}});
  }
  return areas;
}

/// The areas of one count with their trees and rays, for all top levels.
struct ManyAreas {
  std::shared_ptr<const TriangleMesh> mesh;
  std::shared_ptr<const Bvh> global;
  std::vector<LocalTree> locals;
  std::vector<ConvexRegion> regions;
  std::vector<Vec3> points;
  std::vector<Ray> rays;
};

ManyAreas make_areas(const SceneTrees& scene, size_t count, size_t rays, uint64_t seed) {
  ManyAreas many;
  many.mesh = std::make_shared<const TriangleMesh>(scene.mesh);
  many.global = std::make_shared<const Bvh>(scene.global);
  const Bounds box = mesh_bounds(scene.mesh);
  const Registry registry = default_registry();
  for (const InfluenceArea& area : scatter(box, count, seed)) {
    many.locals.push_back(build_local_tree(*many.mesh, area, {"PAH", "ALL", "binned", {}}, registry));
    many.regions.push_back(AreaGeometry(area).region());
    const std::vector<Ray> cast = cast_rays(AreaRays{.area = area}, (rays + count - 1) / count, seed);
    many.rays.insert(many.rays.end(), cast.begin(), cast.end());
  }
  Random random(seed + 1);
  for (size_t i = 0; i < kQueries; ++i) many.points.push_back(point_in(random, box));
  return many;
}

void set_ray_cells(Cells& cells, const ManyAreas& many, const TopLevelOptions& options) {
  const Accelerator accelerator(many.mesh, many.locals, many.global, options, Traversal::kBinary);
  AcceleratorCounters counters;
  TraceCounters alone;
  size_t mismatches = 0;
  for (const Ray& ray : many.rays) {
    const Hit hit = accelerator.intersect(ray, &counters);
    mismatches += hit == intersect(*many.global, *many.mesh, ray, {}, {}, &alone) ? 0 : 1;
  }
  double least = kInf;
  for (int pass = 0; pass < kTimedPasses; ++pass) {
    const Timer timer;
    for (const Ray& ray : many.rays) accelerator.intersect(ray);
    least = std::min(least, timer.seconds());
  }
  const double count = static_cast<double>(many.rays.size());
  TraceCounters work = counters.local;
  work.add(counters.global);
  cells.set("areas_tested", static_cast<double>(counters.areas_tested) / count);
  cells.set("pruned_cost_with_fallback", ray_cost(work, {}) / count);
  cells.set("global_pruned_cost", ray_cost(alone, {}) / count);
  cells.set("local_hit_ratio", static_cast<double>(counters.local_hits) / count);
  cells.set("mismatches", static_cast<double>(mismatches));
  cells.set("rays", count);
  cells.set("ray_seconds", least / count);
}

std::vector<std::string> run_row(const ManyAreas& many, const TopLevelOptions& options) {
  const bool is_list = options.kind == TopLevelKind::kList;
  const TopLevelStats stats = analyze_top_level(many.regions, options, many.points);
  Cells cells(columns());
  cells.set("areas", static_cast<double>(many.locals.size()));
  cells.set("top_level", is_list ? "list" : "octree");
  if (!is_list) cells.set("top_level_max_level", options.max_level);
  cells.set("top_level_nodes", static_cast<double>(stats.nodes));
  cells.set("top_level_leaves", static_cast<double>(stats.leaves));
  cells.set("top_level_areas_per_leaf", stats.areas_per_leaf);
  cells.set("top_level_false_candidates", stats.false_candidates);
  cells.set("top_level_memory_bytes", static_cast<double>(stats.memory_bytes));
  cells.set("top_level_paper_memory_bytes", static_cast<double>(stats.paper_memory_bytes));
  cells.set("top_level_build_seconds", stats.build_seconds);
  cells.set("top_level_query_seconds", stats.query_seconds);
  set_ray_cells(cells, many, options);
  return cells.take();
}

struct LazyAreas {
  std::once_flag once;
  ManyAreas areas;
};

}  // namespace

Study areas_study(const StudySources& sources) {
  Study study{"areas", columns(), {}, "rays " + std::to_string(sources.rays), {}};
  std::vector<StudyScene> scenes{procedural_scene("procedural:city", "City")};
  check_wanted(sources,
               sources.quick ? std::vector<std::string_view>{"City"} : std::vector<std::string_view>{"City", "Sponza"});
  StudySources sponza = sources;
  sponza.only = {"Sponza"};
  if (is_wanted(sources, "Sponza") && !sources.quick)
    for (const StudyScene& scene : paper_scenes(sponza, study.missing)) scenes.push_back(scene);
  study.identity += contents_of(scenes);
  for (const StudyScene& scene : scenes) {
    if (!is_wanted(sources, scene.name)) continue;
    const auto trees = std::make_shared<LazyScene>([load = scene.load] {
      TriangleMesh mesh = load();
      Bvh global = build_global_tree(mesh, {"SAH", "ALL", "binned", {}}, default_registry());
      return make_scene_trees(std::move(mesh), std::move(global));
    });
    const size_t most = sources.quick ? 4 : (is_large(scene) && scene.name == "Sponza" ? 64 : 256);
    for (size_t count = 1; count <= most; count *= 2) {
      const auto lazy = std::make_shared<LazyAreas>();
      const auto add = [&](const TopLevelOptions& options, const std::string& combo, const std::string& setting) {
        const auto run = [=, rays = sources.rays, seed = sources.seed] {
          std::call_once(lazy->once, [&] { lazy->areas = make_areas(trees->get(), count, rays, seed); });
          return run_row(lazy->areas, options);
        };
        study.add({scene.name, "", fmt::format("{} areas", count), combo, setting, "matched", sources.seed, 1}, run,
                  scene.weight);
      };
      add({TopLevelKind::kList, 0}, "list", "");
      for (uint32_t level = 3; level <= 8; ++level)
        add({TopLevelKind::kOctree, level}, "octree", fmt::format("level {}", level));
    }
  }
  return study;
}

}  // namespace raygrain::study
