// The study `visibility`: what a measure that knows where rays end is worth for splits, for reinsertion and for wide
// forms, beside the measures that do not know.
#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "raygrain/analyze.h"
#include "raygrain/compare.h"
#include "raygrain/io.h"
#include "raygrain/refine.h"

#include "base/timer.h"
#include "study/presets.h"
#include "study/scene_pool.h"
#include "study/sources.h"

namespace raygrain::study {
namespace {

constexpr int kTimedPasses = 7;  // of a row and of its baseline in turn; the least time of each is reported

struct Variant {
  const char* measure;  // of the splits
  const char* setting;  // in the rows
  bool reinsert = false;
  bool wide_by_visible = false;  // the wide form alone knows what rays see
};

constexpr std::array<Variant, 8> kVariants{{{"PAH", ""},
                                            {"SAH", ""},
                                            {"VISIBLE", ""},
                                            {"PAH", "reinsertion", true},
                                            {"SAH", "reinsertion", true},
                                            {"VISIBLE", "reinsertion", true},
                                            {"PAH", "wide by VISIBLE", false, true},
                                            {"PAH", "reinsertion, wide by VISIBLE", true, true}}};

const std::vector<StudyColumn>& columns() {
  static const std::vector<StudyColumn> all{{"triangles"},
                                            {"rays"},
                                            {"ended_samples"},
                                            {"estimated_own"},
                                            {"real_cost"},
                                            {"pruned_cost"},
                                            {"nearest_nodes"},
                                            {"nearest_triangles"},
                                            {"any_nodes"},
                                            {"any_triangles"},
                                            {"build_seconds", false},
                                            {"nearest_seconds", false},
                                            {"any_seconds", false},
                                            {"plain_build_seconds", false},
                                            {"plain_nearest_seconds", false},
                                            {"plain_any_seconds", false}};
  return all;
}

/// An area of a scene, made of its box: a sun, a camera outside and one inside.
InfluenceArea make_area(const std::string& variant, const Bounds& box) {
  const Vec3 size = extent(box), middle = center(box);
  if (variant == "sun") return directional_light_area(variant, {0.3f, -0.8f, 0.5f}, box);
  const float floor = box.lo.y;
  if (variant == "camera") {
    const Vec3 eye{box.lo.x - 0.2f * size.x, floor + 0.4f * size.y, box.lo.z + 0.1f * size.z};
    return camera_area(variant, eye, middle, 60, 1.5f, box);
  }
  const Vec3 eye{middle.x - 0.3f * size.x, floor + 0.3f * size.y, middle.z};
  return camera_area(variant, eye, {middle.x, floor + 0.25f * size.y, middle.z}, 60, 1.5f, box);
}

struct Built {
  LocalTree local;
  WideBvh wide;
  size_t ended = 0;
  double seconds = 0;  // of everything, drawing and ending the samples included
};

Built build(const TriangleMesh& mesh, const InfluenceArea& area, const Variant& variant, uint64_t seed) {
  const Registry registry = default_registry();
  const Recipe recipe{variant.measure, "ALL", "binned", {}}, visible{"VISIBLE", "ALL", "binned", {}};
  const BuildRun one_thread{1, {}, true};
  Built built;
  const Timer timer;
  std::vector<Ray> samples;
  if (needs_samples(recipe, registry) || variant.wide_by_visible)
    samples = samples_for(visible, registry, sample_rays(area, seed), mesh, nullptr, 1);
  built.local = build_local_tree(mesh, area, recipe, registry, {}, samples, one_thread);
  if (variant.reinsert) {
    Bvh tree = *built.local.tree;
    raygrain::reinsert(tree, built.local.measure, {.threads = 1});
    built.local.tree = std::make_shared<const Bvh>(std::move(tree));
  }
  const RayMeasure by = variant.wide_by_visible
                            ? make_build_options(visible, registry, {&area, samples}).strategy.measure
                            : built.local.measure;
  built.wide = WideBvh(*built.local.tree, mesh, {.measure = by, .threads = 1});
  built.seconds = timer.seconds();
  built.ended = static_cast<size_t>(std::ranges::count_if(samples, [](const Ray& ray) { return ray.tmax < kInf; }));
  return built;
}

void set_counts(Cells& cells, const Built& built, const TriangleMesh& mesh, std::span<const Ray> rays) {
  const TraceStats stats = analyze_rays(*built.local.tree, mesh, rays, {}, 1);
  TraceCounters nearest, any;
  for (const Ray& ray : rays) {
    built.wide.intersect_counted(ray, nearest);
    built.wide.occluded_counted(ray, any);
  }
  const auto per_ray = [&](uint64_t count) { return static_cast<double>(count) / static_cast<double>(rays.size()); };
  cells.set("triangles", static_cast<double>(built.local.tree->prims.size()));
  cells.set("rays", static_cast<double>(rays.size()));
  cells.set("ended_samples", static_cast<double>(built.ended));
  cells.set("estimated_own", analyze(*built.local.tree, built.local.measure).estimated_cost);
  cells.set("real_cost", stats.real_cost);
  cells.set("pruned_cost", stats.pruned_cost);
  cells.set("nearest_nodes", per_ray(nearest.inner_hits));
  cells.set("nearest_triangles", per_ray(nearest.leaf_triangles));
  cells.set("any_nodes", per_ray(any.inner_hits));
  cells.set("any_triangles", per_ray(any.leaf_triangles));
}

/// Seconds a ray of each of two trees, in turns: what else the machine does then meets both.
std::pair<double, double> race(size_t rays, const std::function<void()>& one, const std::function<void()>& other) {
  const auto time = [&](const std::function<void()>& search, double& least) {
    const Timer timer;
    search();
    least = std::min(least, timer.seconds() / static_cast<double>(rays));
  };
  double first = kInf, second = kInf;
  for (int pass = 0; pass < kTimedPasses; ++pass) time(one, first), time(other, second);
  return {first, second};
}

void set_times(Cells& cells, const Built& built, const Built& plain, std::span<const Ray> rays) {
  std::vector<Hit> hits(rays.size());
  std::vector<uint8_t> flags(rays.size());
  const auto nearest = [&](const Built& tree) { return [&] { tree.wide.intersect(rays, hits); }; };
  const auto any = [&](const Built& tree) { return [&] { tree.wide.occluded(rays, flags); }; };
  const auto [own_nearest, plain_nearest] = race(rays.size(), nearest(built), nearest(plain));
  const auto [own_any, plain_any] = race(rays.size(), any(built), any(plain));
  cells.set("build_seconds", built.seconds);
  cells.set("plain_build_seconds", plain.seconds);
  cells.set("nearest_seconds", own_nearest);
  cells.set("plain_nearest_seconds", plain_nearest);
  cells.set("any_seconds", own_any);
  cells.set("plain_any_seconds", plain_any);
}

std::vector<std::string> run_row(const TriangleMesh& mesh, const std::string& where, const Variant& variant,
                                 const StudySources& sources) {
  const InfluenceArea area = make_area(where, mesh_bounds(mesh));
  const std::vector<Ray> rays = cast_rays(AreaRays{.area = area}, sources.rays, sources.seed);
  const Built plain = build(mesh, area, kVariants[0], sources.seed), built = build(mesh, area, variant, sources.seed);
  Cells cells(columns());
  set_counts(cells, built, mesh, rays);
  set_times(cells, built, plain, rays);
  return cells.take();
}

/// About 100,000 triangles each, and the two large models.
std::vector<StudyScene> scenes_of(const StudySources& sources, std::vector<std::string>& missing) {
  check_wanted(sources, {"City", "Forest", "Terrain", "Sponza", "Crowd"});
  const std::pair<const char*, const char*> kProcedural[] = {{"City", "procedural:city?size=15"},
                                                             {"Forest", "procedural:forest?size=16"},
                                                             {"Terrain", "procedural:terrain?size=224"}};
  const std::pair<const char*, const char*> kQuick[] = {{"City", "procedural:city?size=2"},
                                                        {"Forest", "procedural:forest?size=2"},
                                                        {"Terrain", "procedural:terrain?size=16"}};
  std::vector<StudyScene> extra;
  for (const auto& [name, text] : sources.quick ? kQuick : kProcedural) extra.push_back(procedural_scene(text, name));
  std::vector<StudyScene> scenes;
  for (const char* model : {"Crowd", "Sponza"}) {
    if (!is_wanted(sources, model)) continue;
    StudySources alone = sources;
    alone.only = {model};
    for (StudyScene& scene : paper_scenes(alone, missing)) scenes.push_back(std::move(scene));
  }
  for (const StudyScene& scene : extra)
    if (is_wanted(sources, scene.name)) scenes.push_back(scene);
  return scenes;
}

}  // namespace

Study visibility_study(const StudySources& sources) {
  Study study{"visibility", columns(), {}, "", {}};
  const std::vector<StudyScene> scenes = scenes_of(sources, study.missing);
  study.identity = "rays " + std::to_string(sources.rays) + contents_of(scenes);
  for (const StudyScene& scene : scenes) {
    const auto trees = std::make_shared<LazyScene>([load = scene.load] {
      TriangleMesh mesh = load();
      Recipe quick;
      set_quality(quick, Quality::kFast);
      Bvh global = build_global_tree(mesh, quick, default_registry());
      return make_scene_trees(std::move(mesh), std::move(global));
    });
    for (const char* where : {"sun", "camera", "inside"})
      for (const Variant& variant : kVariants)
        study.add(
            {scene.name, std::string(where) == "sun" ? "plane" : "point", where,
             std::string(variant.measure) + "+ALL@binned", variant.setting, "matched", sources.seed, 1},
            [trees, where, variant, sources] { return run_row(trees->get().mesh, where, variant, sources); },
            scene.weight);
  }
  return study;
}

}  // namespace raygrain::study
