// raygrain trace: nearest or any hits of given rays, through what areas have and the global tree.
#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "raygrain/accelerator.h"
#include "raygrain/compare.h"
#include "raygrain/error.h"
#include "raygrain/io.h"

#include "cli/areas.h"
#include "cli/commands.h"
#include "cli/given_rays.h"
#include "cli/memory.h"
#include "cli/open_scene.h"
#include "cli/recipe_options.h"
#include "cli/structures.h"
#include "cli/trace_report.h"
#include "cli/tree_file.h"
#include "cli/values.h"

namespace raygrain::cli {

namespace {

constexpr const char* kDefaultLocal = "PAH+ALL@binned";
constexpr const char* kDefaultGlobal = "SAH+ALL@binned";

struct Options {
  CommonOptions common;
  AreaOptions areas;
  RayOptions rays;
  StructureOptions structures;
  std::string scene, output;
  std::string local = kDefaultLocal, global = kDefaultGlobal;
  std::string quality, tree, traversal = "wide";
  std::string wide_measure;
  bool any = false, verify = false, reinsert = false, reinsert_local = false;
};

AcceleratorOptions accelerator_options(const Options& options) {
  AcceleratorOptions result;
  result.local = recipe_option("--local", options.local, result.registry);
  result.global = recipe_option("--global", options.global, result.registry);
  result.global.for_wide = result.global.builder != "paper";
  if (!options.quality.empty()) {
    if (options.global.find('@') != std::string::npos && options.global != kDefaultGlobal)
      fail_usage("--quality", "cannot be combined with a recipe that names its builder", "Leave one of them out");
    result.quality = quality_option(options.quality);
  }
  result.reinsert = options.reinsert;
  result.reinsert_local = options.reinsert_local;
  result.wide_measure = options.wide_measure;
  if (!options.wide_measure.empty()) check_measure_option("--wide-measure", options.wide_measure, result.registry);
  if (options.traversal != "wide" && options.traversal != "binary")
    fail_usage("--traversal", "unknown form '" + options.traversal + "'", "Known: wide, binary");
  if (options.traversal == "binary" && !options.wide_measure.empty())
    fail_usage("--wide-measure", "says how wide forms are made, and --traversal binary has none",
               "Leave one of them out");
  result.traversal = options.traversal == "wide" ? Traversal::kWide : Traversal::kBinary;
  result.routing = Routing::kAreas;  // whoever names a recipe wants to see its trees searched
  set_structures(options.structures, result);
  result.threads = options.common.thread_count();
  Recipe wide = result.local;
  if (!options.wide_measure.empty()) wide.measure = options.wide_measure;
  const size_t count = std::max(sample_count(result.local, result.registry), sample_count(wide, result.registry));
  result.samples = [count](const InfluenceArea* area) {
    return area ? sample_rays(*area, 1, count) : std::vector<Ray>{};
  };
  return result;
}

/// The first option that is about areas' trees; "" without any.
std::string given_local_option(const Options& options) {
  if (options.local != kDefaultLocal) return "--local";
  if (options.reinsert_local) return "--reinsert-local";
  return options.wide_measure.empty() ? "" : "--wide-measure";
}

void check_options(const Options& options) {
  check_area_options(options.areas);
  if (!options.tree.empty() && (!options.quality.empty() || options.reinsert || options.global != kDefaultGlobal))
    fail_usage("--tree", "cannot be combined with --global, --quality or --reinsert",
               "They say how a new tree is built");
  if (!options.tree.empty() && (options.reinsert_local || !options.wide_measure.empty()))
    fail_usage("--tree", "cannot be combined with --reinsert-local or --wide-measure", "Leave one of them out");
  const std::string structure = given_structure_option(options.structures);
  if (!options.tree.empty() && !structure.empty())
    fail_usage("--tree", "cannot be combined with " + structure, "Beside a built tree areas have trees of the world");
  const std::string local = given_local_option(options);
  if (options.structures.space == "none" && !local.empty())
    fail_usage(local, "is about areas' trees, and --space none builds none", "Leave one of them out");
  check_ray_options(options.rays);
  if (!options.rays.is_given()) fail_usage("--rays", "no rays are given", kRaysHint);
}

void require_areas(const Options& options, const Scene& scene, const std::vector<InfluenceArea>& areas) {
  const std::string local = given_local_option(options), structure = given_structure_option(options.structures);
  if (areas.empty() && !(local + structure).empty()) {
    refuse_empty_areas(options.areas, scene, options.scene);
    fail_usage(local.empty() ? structure : local, "is about influence areas, and there are none", kAreasHint);
  }
  check_structures_of(options.structures, areas);
}

/// With the global tree of a file, where one is given.
Accelerator make_accelerator(const Options& options, const Scene& scene, const std::vector<InfluenceArea>& areas,
                             const AcceleratorOptions& build) {
  if (options.tree.empty()) return Accelerator(scene.mesh, areas, build);
  auto global = std::make_shared<const Bvh>(load_tree_for(scene.mesh, options.tree));
  std::vector<LocalTree> locals;
  locals.reserve(areas.size());
  for (const InfluenceArea& area : areas) {
    const std::vector<Ray> samples =
        samples_for(build.local, build.registry, build.samples(&area), scene.mesh, global.get(), build.threads);
    locals.push_back(
        build_local_tree(scene.mesh, area, build.local, build.registry, {}, samples, {build.threads, {}, true}));
  }
  return Accelerator(std::make_shared<const TriangleMesh>(scene.mesh), std::move(locals), std::move(global),
                     build.top_level, build.traversal);
}

Traced trace_and_verify(const Options& options, const Scene& scene, const std::vector<InfluenceArea>& areas,
                        std::span<const Ray> rays, Progress& progress) {
  const double built = options.verify ? 0.1 : 0.5, traced_share = options.verify ? 0.2 : 1;
  const unsigned threads = options.common.thread_count();
  AcceleratorOptions build = accelerator_options(options);
  build.progress = [&](double done) {
    progress.show("build the trees", built * done);
    return true;
  };
  require_memory("tracing", bytes_of_accelerator(scene.mesh, areas, build),
                 "Take --quality fast, --space none, a smaller scene or fewer areas");
  const Accelerator accelerator = make_accelerator(options, scene, areas, build);
  Traced traced{rays.size(),
                ask_rays(accelerator, rays, options.any, threads,
                         [&](double done) { progress.show("trace rays", built + done * (traced_share - built)); }),
                {}};
  if (!options.verify) return traced;
  traced.checked = check_answers(accelerator, rays, traced.answers, threads, [&](double done) {
    progress.show("search by brute force", traced_share + done * (1 - traced_share));
  });
  return traced;
}

/// One column: 1 where the ray hits anything.
void save_flags(std::span<const uint8_t> flags, const std::string& path) {
  write_file_atomically(path, [&](std::ostream& out) {
    out << "occluded\n";
    for (const uint8_t flag : flags) out << (flag != 0 ? "1\n" : "0\n");
  });
}

int trace(const Options& options) {
  check_options(options);
  accelerator_options(options);  // recipes are checked before the scene is loaded
  const Output output(options.common);
  require_writable(options.output);
  Progress progress(!options.common.quiet);
  const Scene scene = open_scene(options.scene, progress);
  const std::vector<InfluenceArea> areas = choose_areas(options.areas, scene, output);
  require_areas(options, scene, areas);
  const std::vector<Ray> rays = given_rays(options.rays, scene);

  const Traced traced = trace_and_verify(options, scene, areas, rays, progress);
  if (options.any)
    save_flags(traced.answers.flags, options.output);
  else
    save_hits(traced.answers.hits, options.output);
  progress.erase();
  output.save_json(trace_json(traced, scene, options.common.thread_count()));
  output.print(trace_text(traced, scene, areas.size()));
  if (options.structures.routing != "cheapest") output.note(unused_trees_note(traced, options.structures.space));
  output.note("Written:\n  " + options.output + "\n");
  if (!traced.checked || traced.checked->wrong == 0) return kSuccess;
  throw Error(ErrorCode::kLimit, options.output, fmt::format("{} rays GOT WRONG ANSWERS", traced.checked->wrong),
              "This is a defect of raygrain: do not use these results, and please report it");
}

}  // namespace

Action declare_trace(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.operand("SCENE", options->scene, kSceneHelp);
  add_ray_options(arguments, options->rays);
  arguments.flag("--any", options->any, "Ask whether these rays hit anything, not for their nearest hits");
  arguments.output("-o,--output", "HITS.csv", options->output,
                   "Hits: columns t,u,v,triangle, a miss is inf,0,0,-1; with --any one column, 1 for a hit");
  arguments.require("--output");
  arguments.flag("--verify", options->verify,
                 "Ask any hits and nearest hits, together and one by one, and check all against brute force (slow)");
  add_area_options(arguments, options->areas);
  arguments.group("Trees");
  arguments.text("--local", "RECIPE", options->local, "Recipe of each area's tree [PAH+ALL@binned]");
  arguments.text("--global", "RECIPE", options->global, "Recipe of the tree for all other rays [SAH+ALL@binned]");
  arguments.text("--quality", "NAME", options->quality,
                 "Of the global tree: fast, balanced or best, in place of its builder");
  arguments.flag("--reinsert", options->reinsert, "Improve the global tree by reinsertion, under its measure");
  arguments.flag("--reinsert-local", options->reinsert_local, "Improve the areas' trees, likewise");
  arguments.text("--wide-measure", "NAME", options->wide_measure,
                 "What makes the wide forms of the areas' trees, e.g. VISIBLE [their recipe's]");
  arguments.file(
      "--tree", "FILE.rgt", options->tree,
      "A built tree of the whole scene in place of the global tree; areas then have trees of the world alone, no "
      "coverage");
  arguments.text("--traversal", "NAME", options->traversal, "Form of the trees: wide, or binary (slower) [wide]");
  add_structure_options(arguments, options->structures, Routing::kAreas);
  add_common(arguments, options->common);
  return [options] { return trace(*options); };
}

}  // namespace raygrain::cli
