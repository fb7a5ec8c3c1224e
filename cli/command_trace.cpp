// raygrain trace: the nearest hits of given rays, through local trees and the global one.
#include <algorithm>
#include <functional>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "raygrain/accelerator.h"
#include "raygrain/compare.h"
#include "raygrain/error.h"
#include "raygrain/io.h"
#include "raygrain/report.h"

#include "base/parallel.h"
#include "base/timer.h"
#include "cli/areas.h"
#include "cli/commands.h"
#include "cli/environment_json.h"
#include "cli/given_rays.h"
#include "cli/memory.h"
#include "cli/open_scene.h"
#include "cli/tree_file.h"
#include "cli/values.h"

namespace raygrain::cli {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kDefaultGlobal = "SAH+ALL@binned";

struct Options {
  CommonOptions common;
  AreaOptions areas;
  RayOptions rays;
  std::string scene, output;
  std::string local = "PAH+ALL@binned", global = kDefaultGlobal;
  std::string quality, tree, traversal = "wide";
  std::string wide_measure;
  bool verify = false, reinsert = false, reinsert_local = false;
};

struct Traced {
  std::vector<Hit> hits;
  AcceleratorCounters counters;
  size_t hit_count = 0, mismatches = 0;
  double seconds = 0;
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
  result.threads = options.common.thread_count();
  Recipe wide = result.local;
  if (!options.wide_measure.empty()) wide.measure = options.wide_measure;
  const size_t count = std::max(sample_count(result.local, result.registry), sample_count(wide, result.registry));
  result.samples = [count](const InfluenceArea* area) {
    return area ? sample_rays(*area, 1, count) : std::vector<Ray>{};
  };
  return result;
}

using Tell = std::function<void(double done)>;

/// In large pieces, so that progress can be told between them.
Traced trace_all(const Accelerator& accelerator, std::span<const Ray> rays, unsigned threads, const Tell& tell) {
  constexpr size_t kPiece = 65536;
  Traced traced;
  traced.hits.resize(rays.size());
  const Timer timer;
  for (size_t start = 0; start < rays.size(); start += kPiece) {
    tell(static_cast<double>(start) / static_cast<double>(rays.size()));
    const size_t count = std::min(kPiece, rays.size() - start);
    accelerator.intersect(rays.subspan(start, count), std::span(traced.hits).subspan(start, count), threads,
                          &traced.counters);
  }
  traced.seconds = timer.seconds();
  for (const Hit& hit : traced.hits) traced.hit_count += is_hit(hit) ? 1 : 0;
  return traced;
}

/// Brute force is slow: small pieces.
size_t count_wrong(const TriangleMesh& mesh, std::span<const Ray> rays, std::span<const Hit> hits, unsigned threads,
                   const Tell& tell) {
  constexpr size_t kPiece = 256;
  std::vector<uint8_t> wrong(rays.size());
  for (size_t start = 0; start < rays.size(); start += kPiece) {
    tell(static_cast<double>(start) / static_cast<double>(rays.size()));
    parallel_for(std::min(kPiece, rays.size() - start), 8, threads, [&](size_t begin, size_t end) {
      for (size_t i = start + begin; i < start + end; ++i) wrong[i] = intersect_reference(mesh, rays[i]) != hits[i];
    });
  }
  return static_cast<size_t>(std::count(wrong.begin(), wrong.end(), 1));
}

Json work(const TraceCounters& c) {
  return {{"inner_hits", c.inner_hits},
          {"leaf_hits", c.leaf_hits},
          {"leaf_triangles", c.leaf_triangles},
          {"box_tests", c.box_tests},
          {"triangle_tests", c.triangle_tests}};
}

std::string trace_json(const Options& options, const Scene& scene, const Traced& traced) {
  const AcceleratorCounters& c = traced.counters;
  Json report{{"scene", scene.name},
              {"triangles", scene.mesh.triangle_count()},
              {"environment", environment_json(options.common.thread_count())},
              {"rays", traced.hits.size()},
              {"hits", traced.hit_count},
              {"trace_seconds", traced.seconds},
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
  if (options.verify) report["mismatches"] = traced.mismatches;
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string trace_text(const Options& options, const Scene& scene, size_t areas, const Traced& traced) {
  const AcceleratorCounters& c = traced.counters;
  std::string text = fmt::format("{}: {} triangles, {} areas\n", scene.name, scene.mesh.triangle_count(), areas);
  const auto line = [&](const char* name, uint64_t value) { text += fmt::format("  {:<36} {:>12}\n", name, value); };
  line("rays", traced.hits.size());
  line("hits", traced.hit_count);
  line("invalid rays (misses)", c.invalid_rays);
  line("answered by the coverage of an area", c.covered);
  line("areas asked", c.areas_tested);
  line("areas that serve", c.areas_serving);
  line("searches of local trees", c.local_searches);
  line("hits accepted from local trees", c.local_hits);
  line("searches that went on in a next area", c.continued);
  line("searches of the global tree", c.global_searches);
  line("boxes tested", c.local.box_tests + c.global.box_tests);
  line("triangles tested", c.local.triangle_tests + c.global.triangle_tests);
  if (options.verify) line("differences from brute force", traced.mismatches);
  return text;
}

void check_options(const Options& options) {
  check_area_options(options.areas);
  if (!options.tree.empty() && (!options.quality.empty() || options.reinsert || options.global != kDefaultGlobal))
    fail_usage("--tree", "cannot be combined with --global, --quality or --reinsert",
               "They say how a new tree is built");
  if (!options.tree.empty() && (options.reinsert_local || !options.wide_measure.empty()))
    fail_usage("--tree", "cannot be combined with --reinsert-local or --wide-measure", "Leave one of them out");
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
  Traced traced = trace_all(accelerator, rays, threads,
                            [&](double done) { progress.show("trace rays", built + done * (traced_share - built)); });
  if (!options.verify) return traced;
  traced.mismatches = count_wrong(scene.mesh, rays, traced.hits, threads, [&](double done) {
    progress.show("search by brute force", traced_share + done * (1 - traced_share));
  });
  return traced;
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

  Traced traced = trace_and_verify(options, scene, areas, rays, progress);
  save_hits(traced.hits, options.output);
  progress.erase();
  output.save_json(trace_json(options, scene, traced));
  output.print(trace_text(options, scene, areas.size(), traced));
  output.note("Written:\n  " + options.output + "\n");
  if (traced.mismatches == 0) return kSuccess;
  throw Error(ErrorCode::kLimit, options.output, fmt::format("{} rays GOT WRONG HITS", traced.mismatches),
              "This is a defect of raygrain: do not use these results, and please report it");
}

}  // namespace

Action declare_trace(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.operand("SCENE", options->scene, kSceneHelp);
  add_ray_options(arguments, options->rays);
  arguments.output("-o,--output", "HITS.csv", options->output, "Hits: columns t,u,v,triangle; a miss is inf,0,0,-1");
  arguments.require("--output");
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
  arguments.flag("--verify", options->verify, "Check every hit against brute force (slow)");
  add_common(arguments, options->common);
  return [options] { return trace(*options); };
}

}  // namespace raygrain::cli
