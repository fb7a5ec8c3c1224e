// raygrain explain: what each influence area costs and saves, and which of given rays its structures answer.
#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "raygrain/accelerator.h"

#include "base/quantity_text.h"
#include "cli/areas.h"
#include "cli/commands.h"
#include "cli/environment_json.h"
#include "cli/given_rays.h"
#include "cli/memory.h"
#include "cli/open_scene.h"
#include "cli/recipe_options.h"
#include "cli/structures.h"
#include "cli/values.h"

namespace raygrain::cli {

namespace {

using Json = nlohmann::ordered_json;

struct Options {
  CommonOptions common;
  AreaOptions areas;
  RayOptions rays;
  StructureOptions structures;
  std::string scene, quality;
  uint64_t samples = 4096;
  bool any = false;
};

AcceleratorOptions accelerator_options(const Options& options) {
  AcceleratorOptions result;
  if (!options.quality.empty()) result.quality = quality_option(options.quality);
  set_structures(options.structures, result);
  result.threads = options.common.thread_count();
  return result;
}

/// The rays that are given, as one array.
AcceleratorCounters count_rays(const Accelerator& accelerator, std::span<const Ray> rays, const Options& options) {
  AcceleratorCounters counters;
  if (rays.empty()) return counters;
  const unsigned threads = options.common.thread_count();
  if (options.any) {
    std::vector<uint8_t> flags(rays.size());
    accelerator.occluded(rays, flags, threads, &counters);
  } else {
    std::vector<Hit> hits(rays.size());
    accelerator.intersect(rays, hits, threads, &counters);
  }
  return counters;
}

Json use_json(const AreaUse& use) {
  return {{"covered", use.covered}, {"local", use.local}, {"global", use.global}};
}

Json area_json(const AreaReport& area) {
  Json questions = Json::array();
  for (const AreaTimes& t : area.times)
    questions.push_back({{"question", name(t.question)},
                         {"rays", t.rays},
                         {"answered", use_json(t.use)},
                         {"area_nanoseconds", t.area_nanoseconds},
                         {"global_nanoseconds", t.global_nanoseconds},
                         {"break_even_rays", t.break_even_rays}});  // null where it is infinite
  return {{"name", area.name},
          {"structures", area.structures},
          {"triangles", area.triangles},
          {"build_seconds", area.build_seconds},
          {"memory_bytes", area.memory_bytes},
          {"routes", area.routes},
          {"questions", std::move(questions)},
          {"answered", use_json(area.use)},
          {"share", area.share}};
}

std::string explanation_json(const Options& options, const Scene& scene, const Explanation& explanation) {
  Json areas = Json::array();
  for (const AreaReport& area : explanation.areas) areas.push_back(area_json(area));
  const AcceleratorCounters& c = explanation.counters;
  const Json report{{"scene", scene.name},
                    {"triangles", scene.mesh.triangle_count()},
                    {"environment", environment_json(options.common.thread_count())},
                    {"global_bytes", explanation.global_bytes},
                    {"shared_bytes", explanation.shared_bytes},
                    {"rays", c.rays},
                    {"invalid_rays", c.invalid_rays},
                    {"covered", c.covered},
                    {"local_searches", c.local_searches},
                    {"columns", c.columns},
                    {"cones", c.cones},
                    {"global_searches", c.global_searches},
                    {"areas", std::move(areas)}};
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

struct Line {
  const AreaReport* area;
  const AreaTimes* times;
};

/// All questions, those first that pay soonest.
std::string times_table(const Explanation& explanation) {
  std::vector<Line> lines;
  size_t width = 4;
  for (const AreaReport& area : explanation.areas) {
    width = std::max(width, area.name.size());
    for (const AreaTimes& times : area.times) lines.push_back({&area, &times});
  }
  std::ranges::stable_sort(lines, {}, [](const Line& line) { return line.times->break_even_rays; });
  std::string text = fmt::format("{:<{}}  {:<24} {:>13} {:>9} {:>9} {:>9} {:>9}\n", "area", width, "question",
                                 "pays after", "ns a ray", "global", "coverage", "its tree");
  for (const Line& line : lines) {
    const AreaTimes& times = *line.times;
    const auto percent = [&](uint64_t part) {
      return fmt::format("{:.1f} %", 100 * static_cast<double>(part) / static_cast<double>(times.rays));
    };
    const double pays = times.break_even_rays;
    text +=
        fmt::format("{:<{}}  {:<24} {:>13} {:>9.1f} {:>9.1f} {:>9} {:>9}\n", line.area->name, width,
                    name(times.question), std::isinf(pays) ? "never" : rough_count_text(pays), times.area_nanoseconds,
                    times.global_nanoseconds, percent(times.use.covered), percent(times.use.local));
  }
  for (const AreaReport& area : explanation.areas)
    if (const std::string_view missing = missing_times(area); !missing.empty())
      text += fmt::format("{:<{}}  {}\n", area.name, width, missing);
  const bool any_pays = !lines.empty() && std::isfinite(lines.front().times->break_even_rays);
  return text + (any_pays ? "\"pays after\" is rough: builds are timed once\n" : "");
}

std::string explanation_text(const Options& options, const Scene& scene, Explanation explanation) {
  const std::string table = times_table(explanation);
  for (AreaReport& area : explanation.areas) area.times.clear();  // stand in the table
  const bool has_none = options.rays.is_given() && explanation.counters.rays == 0;
  const size_t count = explanation.areas.size();
  return fmt::format("{}: {} triangles, {} area{}\n\n{}\n{}{}", scene.name, scene.mesh.triangle_count(), count,
                     count == 1 ? "" : "s", table, to_text(explanation), has_none ? "0 rays given\n" : "");
}

int explain(const Options& options) {
  check_area_options(options.areas);
  check_ray_options(options.rays);
  if (options.any && !options.rays.is_given()) fail_usage("--any", "there are no rays to ask about", kRaysHint);
  AcceleratorOptions build = accelerator_options(options);
  const Output output(options.common);
  Progress progress(!options.common.quiet);
  const Scene scene = open_scene(options.scene, progress);
  const std::vector<InfluenceArea> areas = choose_areas(options.areas, scene, output);
  if (areas.empty()) fail_without_areas(options.areas, scene, options.scene);
  check_structures_of(options.structures, areas);
  const std::vector<Ray> rays = given_rays(options.rays, scene);
  build.progress = [&](double done) {
    progress.show("build the structures", 0.8 * done);
    return true;
  };
  constexpr double kSampleBytes = 160;  // rays of both kinds, what they share, answers
  require_memory("explaining",
                 bytes_of_accelerator(scene.mesh, areas, build) + kSampleBytes * static_cast<double>(options.samples),
                 "Take fewer --samples, --quality fast, --space none, a smaller scene or fewer areas");
  const Accelerator accelerator(scene.mesh, areas, build);
  progress.show("ask the areas", 0.8);
  const Explanation explanation = accelerator.explain(count_rays(accelerator, rays, options), options.samples);
  progress.erase();
  output.save_json(explanation_json(options, scene, explanation));
  output.print(explanation_text(options, scene, explanation));
  return kSuccess;
}

}  // namespace

Action declare_explain(Arguments& arguments) {
  constexpr uint64_t kMostSamples = 1'000'000;  // more take minutes, and times are no better
  const auto options = std::make_shared<Options>();
  arguments.operand("SCENE", options->scene, kSceneHelp);
  arguments.whole("--samples", options->samples, {1, kMostSamples}, "Rays to cast and time for each area and question");
  add_ray_options(arguments, options->rays);
  arguments.flag("--any", options->any, "Ask whether these rays hit anything, not for their nearest hits");
  add_area_options(arguments, options->areas);
  add_structure_options(arguments, options->structures, Routing::kCheapest);
  arguments.text("--quality", "NAME", options->quality, "Of the tree for all other rays: fast, balanced or best");
  add_common(arguments, options->common);
  arguments.footer("With --rays or --set it also says which of these rays, as one array, each area answers.");
  return [options] { return explain(*options); };
}

}  // namespace raygrain::cli
