#include "cli/one_tree.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "raygrain/analyze.h"
#include "raygrain/compare.h"
#include "raygrain/rays.h"
#include "raygrain/refine.h"

#include "base/nearest_name.h"
#include "base/quantity_text.h"
#include "base/timer.h"
#include "cli/memory.h"
#include "cli/recipe_options.h"
#include "cli/tree_file.h"
#include "cli/values.h"

namespace raygrain::cli {

namespace {

constexpr double kBuildShare = 0.3;  // of the progress bar

std::string known_names(std::span<const InfluenceArea> areas, const std::string& wanted) {
  std::vector<std::string_view> names;
  for (const InfluenceArea& area : areas) names.push_back(area.name);
  return suggestion(wanted, names);
}

std::optional<InfluenceArea> pick_area(const TreeOptions& options, const Scene& scene,
                                       std::span<const InfluenceArea> areas, bool needed) {
  if (options.whole) {
    if (needed) fail_usage("--recipe", "'" + options.recipe + "' needs an area", "Leave out --whole");
    return std::nullopt;
  }
  if (options.area.empty()) {
    if (areas.size() > 1)
      fail_usage("--area", "the scene has several areas and none is named", known_names(areas, "") + ", or --whole");
    if (areas.empty() && needed) fail_without_areas(options.areas, scene, options.scene);
    return areas.empty() ? std::nullopt : std::optional(areas[0]);
  }
  for (const InfluenceArea& area : areas)
    if (area.name == options.area) return area;
  if (areas.empty()) fail_without_areas(options.areas, scene, options.scene);
  fail_usage("--area", "there is no area '" + options.area + "'", known_names(areas, options.area));
}

/// A tree file in place of a new tree.
void load_one_tree(OneTree& result, const TriangleMesh& mesh, const std::string& file) {
  std::vector<uint32_t> members;
  if (result.area) members = area_members(mesh, AreaGeometry(*result.area));
  result.tree = std::make_shared<const Bvh>(load_tree_for(mesh, file, members));
  result.file = file;
}

/// The log says nothing about nodes that reinsertion moved, and is left without any.
void improve(OneTree& tree, unsigned threads) {
  Bvh better = *tree.tree;
  ReinsertOptions options;
  options.threads = threads;
  reinsert(better, tree.measure(), options);
  tree.log.nodes.clear();
  tree.tree = std::make_shared<const Bvh>(std::move(better));
}

}  // namespace

void add_tree_options(Arguments& arguments, TreeOptions& options) {
  arguments.operand("SCENE", options.scene, kSceneHelp);
  arguments.text("--recipe", "NAME", options.recipe,
                 "What the tree is made by, e.g. PAH+ALL; 'raygrain recipes' lists all");
  arguments.require("--recipe");
  add_area_options(arguments, options.areas);
  arguments.text("--area", "NAME", options.area, "Which area, where there are several");
  arguments.flag("--whole", options.whole, "The tree of the whole scene, of no area");
  arguments.group("Tree");
  arguments.text("--quality", "NAME", options.quality, "fast, balanced or best: replaces the recipe's builder");
  arguments.flag("--reinsert", options.reinsert, "Improve the tree by reinsertion, under the recipe's measure");
  arguments.whole("--seed", options.seed, {}, "Of all rays");
}

RayMeasure OneTree::measure() const {
  return make_build_options(recipe, registry, {area ? &*area : nullptr, samples}).strategy.measure;
}

ReportRow OneTree::row() const {
  const TreeStats stats = analyze(*tree, measure());
  const BuildStats build = analyze_build(*tree, log);
  OverlapStats overlap;
  if (area) overlap = analyze_overlap(*tree, AreaGeometry(*area));
  const bool is_built = file.empty();
  ReportRow result{is_built ? recipe_name(recipe) : file + ", priced as " + recipe_name(recipe), area ? area->name : "",
                   collect_fields(stats, area ? &overlap : nullptr, is_built ? &build : nullptr, nullptr, nullptr)};
  if (is_built && log.nodes.empty())
    for (const FieldId id : {FieldId::kOrientationsPerNode, FieldId::kFallbackShare})
      result.values[id] = std::numeric_limits<double>::quiet_NaN();
  if (is_built && !result.values.has(FieldId::kBuildSeconds)) result.values[FieldId::kBuildSeconds] = seconds;
  return result;
}

std::string OneTree::peak_line() const {
  if (log.peak_bytes == 0) return "";
  return fmt::format("  {:<28} {:>12}  Most memory that the builder held at once, the tree included.\n",
                     "build_peak_memory", bytes_text(static_cast<double>(log.peak_bytes)));
}

std::string OneTree::sample_line() const {
  const bool has_ends = std::ranges::any_of(samples, [](const Ray& ray) { return ray.tmax < kInf; });
  if (!needs_hits(recipe, registry) || has_ends) return "";
  return fmt::format("  No sample ray hits anything: {} hides nothing here.\n", recipe.measure);
}

Recipe check_tree_options(const TreeOptions& options, const Registry& registry) {
  check_area_options(options.areas);
  if (options.whole && !options.area.empty())
    fail_usage("--whole", "cannot be combined with --area", "Leave one of them out");
  Recipe recipe = recipe_option("--recipe", options.recipe, registry);
  if (!options.file.empty() && (!options.quality.empty() || options.reinsert))
    fail_usage("--tree", "cannot be combined with --quality or --reinsert", "They say how a new tree is built");
  if (options.quality.empty()) return recipe;
  if (options.recipe.find('@') != std::string::npos)
    fail_usage("--quality", "cannot be combined with a recipe that names its builder", "Leave one of them out");
  set_quality(recipe, quality_option(options.quality));
  return recipe;
}

OneTree build_one_tree(const TreeOptions& options, const Scene& scene, const std::vector<InfluenceArea>& areas,
                       Progress& progress) {
  OneTree result;
  result.registry = default_registry();
  result.recipe = check_tree_options(options, result.registry);
  const bool samples = needs_samples(result.recipe, result.registry);
  result.area = pick_area(options, scene, areas, samples || needs_area(result.recipe, result.registry));
  const auto draw_samples = [&] {
    if (!samples) return;
    const std::vector<Ray> drawn =
        sample_rays(*result.area, options.seed, sample_count(result.recipe, result.registry));
    result.samples =
        samples_for(result.recipe, result.registry, drawn, scene.mesh, nullptr, options.common.thread_count());
  };
  if (!options.file.empty()) {
    draw_samples();
    load_one_tree(result, scene.mesh, options.file);
    return result;
  }
  require_memory("building " + recipe_name(result.recipe),
                 bytes_of_tree(scene.mesh, result.area ? &*result.area : nullptr, result.recipe),
                 "Take --quality fast or a smaller scene");
  const std::string step = "build " + recipe_name(result.recipe);
  const BuildRun run{options.common.thread_count(),
                     [&](double done) {
                       progress.show(step, kBuildShare * done);
                       return true;
                     },
                     true};
  progress.show(step, 0);
  const Timer timer;
  draw_samples();
  if (result.area) {
    LocalTree local =
        build_local_tree(scene.mesh, *result.area, result.recipe, result.registry, {}, result.samples, run);
    result.tree = local.tree;
    result.log = std::move(local.log);
  } else {
    result.tree = std::make_shared<const Bvh>(
        build_global_tree(scene.mesh, result.recipe, result.registry, &result.log, {}, run));
  }
  if (options.reinsert) improve(result, options.common.thread_count());
  result.seconds = timer.seconds();
  if (options.reinsert) result.log.times.total = result.seconds;  // its parts are the first build's alone
  return result;
}

}  // namespace raygrain::cli
