// raygrain trace: nearest or any hits of given rays, through what areas have and the global tree.
#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "raygrain/accelerator.h"
#include "raygrain/compare.h"
#include "raygrain/error.h"
#include "raygrain/io.h"

#include "cli/areas.h"
#include "cli/asked_rays.h"
#include "cli/commands.h"
#include "cli/environment_json.h"
#include "cli/given_rays.h"
#include "cli/memory.h"
#include "cli/open_scene.h"
#include "cli/structures.h"
#include "cli/tree_file.h"
#include "cli/values.h"

namespace raygrain::cli {

namespace {

using Json = nlohmann::ordered_json;

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
  result.local = parse_recipe(options.local, result.registry);
  result.global = parse_recipe(options.global, result.registry);
  result.global.for_wide = result.global.builder != "paper";
  if (!options.quality.empty()) {
    if (options.global.find('@') != std::string::npos && options.global != kDefaultGlobal)
      fail_usage("--quality", "cannot be combined with a recipe that names its builder", "Leave one of them out");
    result.quality = parse_quality(options.quality);
  }
  result.reinsert = options.reinsert;
  result.reinsert_local = options.reinsert_local;
  result.wide_measure = options.wide_measure;
  if (!options.wide_measure.empty()) parse_recipe(options.wide_measure + "+ALL", result.registry);  // is it known?
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

struct Traced {
  size_t rays = 0;
  RayAnswers answers;
  std::optional<CheckedAnswers> checked;
};

Json work(const TraceCounters& c) {
  return {{"inner_hits", c.inner_hits},
          {"leaf_hits", c.leaf_hits},
          {"leaf_triangles", c.leaf_triangles},
          {"box_tests", c.box_tests},
          {"triangle_tests", c.triangle_tests}};
}

/// A ray, or a search of a local tree, by who answered it.
Json ways(const AcceleratorCounters& c) {
  return {{"covered", c.covered},
          {"columns", c.columns},
          {"cones", c.cones},
          {"local_searches", c.local_searches},
          {"global_searches", c.global_searches}};
}

Json checked_json(const CheckedAnswers& checked) {
  Json rows = Json::array();
  for (const CheckedQuestion& q : checked.questions) {
    Json row{{"question", name(q.question)}};
    row.update(ways(q.counters));
    row["differences"] = q.differences;
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string trace_json(const Options& options, const Scene& scene, const Traced& traced) {
  const AcceleratorCounters& c = traced.answers.counters;
  Json report{{"scene", scene.name},
              {"triangles", scene.mesh.triangle_count()},
              {"environment", environment_json(options.common.thread_count())},
              {"rays", traced.rays},
              {"hits", traced.answers.hit_count()},
              {"trace_seconds", traced.answers.seconds},
              {"counters",
               {{"invalid_rays", c.invalid_rays},
                {"covered", c.covered},
                {"columns", c.columns},
                {"cones", c.cones},
                {"areas_tested", c.areas_tested},
                {"areas_serving", c.areas_serving},
                {"local_searches", c.local_searches},
                {"local_hits", c.local_hits},
                {"continued", c.continued},
                {"global_searches", c.global_searches},
                {"local", work(c.local)},
                {"global", work(c.global)}}}};
  if (traced.checked) {
    report["mismatches"] = traced.checked->wrong;
    report["checked"] = checked_json(*traced.checked);
  }
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string checked_text(const CheckedAnswers& checked) {
  std::string text = fmt::format("\n{:<24} {:>12} {:>12} {:>12} {:>12} {:>12} {:>12}\n", "by brute force", "coverage",
                                 "columns", "cones", "other local", "global", "differences");
  for (const CheckedQuestion& q : checked.questions) {
    const AcceleratorCounters& c = q.counters;
    text += fmt::format("{:<24} {:>12} {:>12} {:>12} {:>12} {:>12} {:>12}\n", name(q.question), c.covered, c.columns,
                        c.cones, c.local_searches - c.columns - c.cones, c.global_searches, q.differences);
  }
  return text;
}

std::string trace_text(const Scene& scene, size_t areas, const Traced& traced) {
  const AcceleratorCounters& c = traced.answers.counters;
  std::string text = fmt::format("{}: {} triangles, {} areas\n", scene.name, scene.mesh.triangle_count(), areas);
  const auto line = [&](const char* name, uint64_t value) { text += fmt::format("  {:<36} {:>12}\n", name, value); };
  line("rays", traced.rays);
  line("hits", traced.answers.hit_count());
  line("invalid rays (misses)", c.invalid_rays);
  line("answered by the coverage of an area", c.covered);
  line("areas asked", c.areas_tested);
  line("areas that serve", c.areas_serving);
  line("searches of local trees", c.local_searches);
  line("... in ray space, as columns", c.columns);
  line("... in ray space, as cones", c.cones);
  line("hits accepted from local trees", c.local_hits);
  line("searches that went on in a next area", c.continued);
  line("searches of the global tree", c.global_searches);
  line("boxes tested", c.local.box_tests + c.global.box_tests);
  line("triangles tested", c.local.triangle_tests + c.global.triangle_tests);
  if (!traced.checked) return text;
  line("differences from brute force", traced.checked->wrong);
  return text + checked_text(*traced.checked);
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
  check_ray_options(options.rays);
  if (!options.rays.is_given()) fail_usage("--rays", "no rays are given", kRaysHint);
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
                 "Take --quality fast, a smaller scene or fewer areas");
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
  const std::vector<Ray> rays = given_rays(options.rays, scene);

  const Traced traced = trace_and_verify(options, scene, areas, rays, progress);
  if (options.any)
    save_flags(traced.answers.flags, options.output);
  else
    save_hits(traced.answers.hits, options.output);
  progress.erase();
  output.save_json(trace_json(options, scene, traced));
  output.print(trace_text(scene, areas.size(), traced));
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
                 "Of that tree: fast, balanced or best, in place of its builder");
  arguments.flag("--reinsert", options->reinsert, "Improve that tree by reinsertion, under its measure");
  arguments.flag("--reinsert-local", options->reinsert_local, "Improve the areas' trees, likewise");
  arguments.text("--wide-measure", "NAME", options->wide_measure,
                 "What makes the wide forms of the areas' trees, e.g. VISIBLE [their recipe's]");
  arguments.file("--tree", "FILE.rgt", options->tree, "A built tree of the whole scene in place of that tree");
  arguments.text("--traversal", "NAME", options->traversal, "Form of the trees: wide, or binary (slower) [wide]");
  add_structure_options(arguments, options->structures, Routing::kAreas);
  add_common(arguments, options->common);
  return [options] { return trace(*options); };
}

}  // namespace raygrain::cli
