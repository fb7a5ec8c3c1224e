// raygrain compare: trees of several recipes for the same areas and rays, side by side.
#include <cmath>
#include <memory>
#include <optional>
#include <ostream>

#include <fmt/format.h>

#include "raygrain/compare.h"
#include "raygrain/error.h"
#include "raygrain/io.h"

#include "cli/areas.h"
#include "cli/commands.h"
#include "cli/memory.h"
#include "cli/open_scene.h"
#include "cli/output_folder.h"
#include "cli/pictures.h"
#include "cli/recipe_options.h"
#include "cli/rows.h"

namespace raygrain::cli {

namespace {

constexpr uint64_t kMostRays = 1'000'000'000;
constexpr double kPictureShare = 0.2;  // of the progress bar

struct Options {
  CommonOptions common;
  AreaOptions areas;
  std::string scene, folder;
  std::vector<std::string> recipes;
  uint64_t rays = 10000, seed = 1;
  bool verify = false;
};

CompareOptions compare_options(const Options& options, Progress& progress) {
  CompareOptions result;
  for (const std::string& recipe : options.recipes)
    result.recipes.push_back(recipe_option("--recipes", recipe, result.registry));
  result.rays = options.rays;
  result.seed = options.seed;
  result.verify = options.verify;
  result.threads = options.common.thread_count();
  const double share = options.folder.empty() ? 1 : 1 - kPictureShare;
  result.progress = [&progress, share](const std::string& step, double done) {
    progress.show(step, done * share);
    return true;
  };
  return result;
}

std::vector<std::string> save_files(const Options& options, const Comparison& comparison,
                                    std::span<const ReportRow> rows, std::span<const AreaResult> results,
                                    Progress& progress) {
  const auto save = [&](const std::string& name, const std::string& text) {
    std::string path = options.folder + "/" + name;
    write_file_atomically(path, [&](std::ostream& out) { out << text; });
    return path;
  };
  std::vector<std::string> paths{
      save("compare.json", rows_json(comparison.scene, comparison.triangles, comparison.seed, options.common, rows)),
      save("compare.csv", csv_table(rows, all_columns(rows)))};
  const auto begin = [&](const std::string& step, double done) {
    progress.show(step, 1 - kPictureShare + done * kPictureShare);
  };
  const std::vector<std::string> pictures =
      save_pictures(comparison, results, options.folder, options.common.thread_count(), begin);
  paths.insert(paths.end(), pictures.begin(), pictures.end());
  return paths;
}

std::string table_text(const Options& options, const Comparison& comparison, std::span<const ReportRow> rows,
                       std::span<const AreaResult> results) {
  std::string text = fmt::format("{}: {} triangles, {} rays{}, seed {}\n\n", comparison.scene, comparison.triangles,
                                 options.rays, results.size() > 1 ? " per area" : "", options.seed);
  text += text_table(rows, table_columns()) + "\n";
  for (const AreaResult& result : results) text += verdict(rows[result.best], rows[result.baseline]) + "\n";
  return text;
}

/// Throws Error when any row's hits were wrong.
void refuse_mismatches(std::span<const ReportRow> rows, uint64_t seed) {
  for (const ReportRow& row : rows) {
    const double mismatches = row.values[FieldId::kMismatches];
    if (mismatches == 0) continue;
    throw Error(ErrorCode::kLimit, row.area + ", " + row.name,
                fmt::format("{:.0f} rays GOT WRONG HITS with seed {}", mismatches, seed),
                "This is a defect of raygrain: do not use these results, and please report it");
  }
}

int compare_scene(const Options& options) {
  check_area_options(options.areas);
  const Output output(options.common);
  Progress progress(!options.common.quiet);
  const CompareOptions work = compare_options(options, progress);
  Scene scene = open_scene(options.scene, progress);
  std::vector<InfluenceArea> areas = choose_areas(options.areas, scene, output);
  if (areas.empty()) fail_without_areas(options.areas, scene, options.scene);
  scene.areas = std::move(areas);
  constexpr double kBytesPerRay = sizeof(Ray) + 2 * sizeof(Hit);
  require_memory("comparing",
                 bytes_of_comparison(scene.mesh, scene.areas, work.recipes.empty() ? paper_recipes() : work.recipes) +
                     static_cast<double>(options.rays) * kBytesPerRay,
                 "Take a smaller scene, fewer recipes or fewer rays");
  std::optional<OutputFolder> folder;
  if (!options.folder.empty()) folder.emplace(options.folder);

  const Comparison comparison = compare(scene, work);
  std::vector<ReportRow> rows;
  for (const ComparisonRow& row : comparison.rows) rows.push_back(report_row(row));
  const std::vector<AreaResult> results = area_results(comparison);
  std::vector<std::string> paths;
  if (!options.folder.empty()) paths = save_files(options, comparison, rows, results, progress);
  progress.erase();

  output.save_json(rows_json(comparison.scene, comparison.triangles, comparison.seed, options.common, rows));
  output.print(table_text(options, comparison, rows, results));
  if (!paths.empty()) output.note("\nWritten:\n");
  for (const std::string& path : paths) output.note("  " + path + "\n");
  refuse_mismatches(rows, options.seed);
  return kSuccess;
}

}  // namespace

Action declare_compare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.operand("SCENE", options->scene, kSceneHelp);
  add_area_options(arguments, options->areas);
  arguments.group("Comparison");
  arguments.list(
      "--recipes", "NAME,...", options->recipes,
      "Trees to compare, as 'raygrain recipes' explains [SAH+LSPH,SAH+SPFH,PAH+LSPH,PAH+SPFH,SAH+ALL,PAH+ALL]");
  arguments.whole("--rays", options->rays, {1, kMostRays}, "Rays per area");
  arguments.whole("--seed", options->seed, {}, "Of the rays");
  arguments.flag("--verify", options->verify, "Check every hit against brute force, too (slow)");
  arguments.output_folder("--out", "DIR", options->folder, {"compare.json", "compare.csv"},
                          "Write compare.json, compare.csv and pictures into this folder");
  add_common(arguments, options->common);
  arguments.footer("Every hit is checked against an independent tree; any difference ends with exit code 1.");
  return [options] { return compare_scene(*options); };
}

}  // namespace raygrain::cli
