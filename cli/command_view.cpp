// raygrain view: scene, areas, trees, rays and costs as one page for a browser.
#include <memory>
#include <ostream>

#include <fmt/format.h>

#include "raygrain/analyze.h"
#include "raygrain/compare.h"
#include "raygrain/error.h"
#include "raygrain/io.h"
#include "raygrain/view.h"

#include "cli/areas.h"
#include "cli/built_page.h"
#include "cli/commands.h"
#include "cli/memory.h"
#include "cli/open_scene.h"
#include "cli/recipe_options.h"
#include "cli/serve.h"
#include "cli/values.h"
#include "io/text.h"

namespace raygrain::cli {

namespace {

constexpr double kBuildShare = 0.8;  // of the progress bar

struct Options {
  CommonOptions common;
  AreaOptions areas;
  std::string scene, page, page_template;
  std::vector<std::string> recipes;
  uint64_t seed = 1;
  bool serve = false;
  uint64_t port = 0;
};

std::string template_path(const Options& options) {
  std::string path = options.page_template.empty() ? built_page("viewer.html") : options.page_template;
  if (path.empty())
    throw Error(ErrorCode::kNotFound, "viewer.html", "the viewer's page is not built",
                "Run make viewer (it needs node and npm), or give a built page with --template");
  return path;
}

std::vector<Recipe> chosen_recipes(const Options& options, bool has_areas, const Registry& registry) {
  std::vector<std::string> names = options.recipes;
  if (names.empty()) names = {"SAH+LSPH", has_areas ? "PAH+ALL" : "SAH+ALL"};
  std::vector<Recipe> recipes;
  recipes.reserve(names.size());
  for (const std::string& name : names) recipes.push_back(recipe_option("--recipes", name, registry));
  for (const Recipe& recipe : recipes)
    if (!has_areas && (needs_area(recipe, registry) || needs_samples(recipe, registry)))
      fail_usage("--recipes", fmt::format("'{}' needs an area and there is none", recipe_name(recipe)),
                 "Add --sun X,Y,Z, --light X,Y,Z, --camera EYE TARGET or --areas FILE.json");
  return recipes;
}

FieldValues known_values(const Bvh& tree, const BuildLog& log, const RayMeasure& measure, const InfluenceArea* area) {
  const BuildStats build = analyze_build(tree, log);
  OverlapStats overlap;
  if (area) overlap = analyze_overlap(tree, AreaGeometry(*area));
  return collect_fields(analyze(tree, measure), area ? &overlap : nullptr, &build, nullptr, nullptr);
}

ViewTree make_tree(const Scene& scene, size_t area, const Recipe& recipe, const Registry& registry,
                   const Options& options, const BuildRun& run) {
  ViewTree result;
  result.recipe = recipe_name(recipe);
  result.area = area;
  const InfluenceArea* where = area == kWholeScene ? nullptr : &scene.areas[area];
  std::vector<Ray> samples;
  BuildRun ended = run;
  ended.samples_are_ended = true;
  if (where && needs_samples(recipe, registry))
    samples = samples_for(recipe, registry, sample_rays(*where, options.seed, sample_count(recipe, registry)),
                          scene.mesh, nullptr, run.threads);
  if (where) {
    LocalTree local = build_local_tree(scene.mesh, *where, recipe, registry, {}, samples, ended);
    result.tree = local.tree;
    result.log = std::move(local.log);
  } else {
    result.tree =
        std::make_shared<const Bvh>(build_global_tree(scene.mesh, recipe, registry, &result.log, samples, ended));
  }
  result.measure = make_build_options(recipe, registry, {where, samples}).strategy.measure;
  result.values = known_values(*result.tree, result.log, result.measure, where);
  return result;
}

std::vector<ViewTree> make_trees(const Scene& scene, const Options& options, Progress& progress) {
  const Registry registry = default_registry();
  const std::vector<Recipe> recipes = chosen_recipes(options, !scene.areas.empty(), registry);
  require_memory("viewing", bytes_of_comparison(scene.mesh, scene.areas, recipes),
                 "Take a smaller scene or fewer recipes");
  const size_t areas = std::max<size_t>(scene.areas.size(), 1);
  std::vector<ViewTree> trees;
  for (size_t area = 0; area < areas; ++area)
    for (const Recipe& recipe : recipes) {
      const double before = static_cast<double>(trees.size()) / static_cast<double>(areas * recipes.size());
      const std::string step = "build " + recipe_name(recipe);
      const BuildRun run{options.common.thread_count(), [&, before](double done) {
                           const double whole = static_cast<double>(areas * recipes.size());
                           progress.show(step, kBuildShare * (before + done / whole));
                           return true;
                         }};
      progress.show(step, kBuildShare * before);
      trees.push_back(make_tree(scene, scene.areas.empty() ? kWholeScene : area, recipe, registry, options, run));
    }
  return trees;
}

void check(const Options& options) {
  if (options.page.empty() && !options.serve)
    fail_usage("raygrain view", "has nothing to do", "Give --out view.html to write a page, or --serve to open it");
  if (options.port != 0 && !options.serve) fail_usage("--port", "is only for --serve", "Add --serve");
  check_area_options(options.areas);
  if (!options.recipes.empty()) chosen_recipes(options, true, default_registry());
}

int view_scene(const Options& options) {
  check(options);
  const Output output(options.common);
  require_writable(options.page);
  const std::string path = template_path(options);
  Progress progress(!options.common.quiet);
  Scene scene = open_scene(options.scene, progress);
  scene.areas = choose_areas(options.areas, scene, output);
  const std::vector<ViewTree> trees = make_trees(scene, options, progress);
  progress.show("pack the page", kBuildShare);
  ViewOptions view;
  view.seed = options.seed;
  const std::string page = view_page(scene, trees, view, read_whole_file(path), path);
  if (!options.page.empty()) write_file_atomically(options.page, [&](std::ostream& out) { out << page; });
  progress.erase();

  output.save_json(fmt::format("{{\"triangles\": {}, \"areas\": {}, \"trees\": {}, \"bytes\": {}}}\n",
                               scene.mesh.triangle_count(), scene.areas.size(), trees.size(), page.size()));
  output.print(fmt::format("{}: {} triangles, {} areas, {} trees, {:.1f} MB\n", scene.name, scene.mesh.triangle_count(),
                           scene.areas.size(), trees.size(), static_cast<double>(page.size()) / 1e6));
  if (!options.page.empty()) output.note("Written: " + options.page + "\n");
  if (options.serve)
    serve_page(page, static_cast<uint16_t>(options.port), [&](const std::string& address) {
      output.print("Open " + address + " in a browser; Ctrl-C ends it.\n");
    });
  return kSuccess;
}

}  // namespace

Action declare_view(Arguments& arguments) {
  constexpr uint64_t kHighestPort = 65535;
  const auto options = std::make_shared<Options>();
  arguments.operand("SCENE", options->scene, kSceneHelp);
  add_area_options(arguments, options->areas);
  arguments.group("View");
  arguments.list("--recipes", "NAME,...", options->recipes,
                 "Trees to show, of every area, as 'raygrain recipes' explains [SAH+LSPH,PAH+ALL]");
  arguments.whole("--seed", options->seed, {}, "Of the rays that the page casts at first, and of samples");
  arguments.output("--out", "view.html", options->page, "Write the page: one file, which needs no network");
  arguments.flag("--serve", options->serve, "Offer the page to browsers of this machine until interrupted");
  arguments.whole("--port", options->port, {0, kHighestPort, 8080}, "Of --serve; 0: any that is free");
  arguments.file("--template", "FILE", options->page_template, "The built page to fill [the one beside the program]");
  add_common(arguments, options->common);
  return [options] { return view_scene(*options); };
}

}  // namespace raygrain::cli
