#include "cli/pictures.h"

#include <fmt/format.h>

#include "raygrain/io.h"

#include "cli/file_names.h"

namespace raygrain::cli {

namespace {

constexpr uint32_t kDepthSide = 800, kCostSide = 520;  // longest sides in pixels
constexpr char kBaseline[] = "SAH+LSPH";

double pruned_cost(const ComparisonRow& row) {
  return row.values[FieldId::kPrunedCost];
}

/// The rows [begin, end) belong to one area.
AreaResult area_result(const Comparison& comparison, size_t begin, size_t end) {
  const std::vector<ComparisonRow>& rows = comparison.rows;
  const std::string& area = rows[begin].area;
  AreaResult result{rows[begin].local->area, best_row(comparison, area), begin, begin};
  for (size_t i = end; i-- > begin;)
    if (rows[i].name == kBaseline) result.baseline = i;
  result.rival = end - begin == 1 ? begin : best_row(comparison, area, result.baseline);
  return result;
}

std::string caption(const ComparisonRow& best, const ComparisonRow& baseline) {
  const std::string text = fmt::format("cost per ray: {} {:.2f}", best.name, pruned_cost(best));
  return &best == &baseline ? text : text + fmt::format(", {} {:.2f}", baseline.name, pruned_cost(baseline));
}

Image depth_picture(const Comparison& comparison, const AreaResult& result, unsigned threads) {
  const ComparisonRow& best = comparison.rows[result.best];
  const PictureSize size = picture_size(result.area, kDepthSide);
  const Image image = shaded_depth(*comparison.mesh, *best.local->tree, result.area, size.width, size.height, threads);
  return captioned(image, fmt::format("{}: as the rays of '{}' see it", comparison.scene, result.area.name),
                   caption(best, comparison.rows[result.baseline]));
}

Image cost_picture(const Comparison& comparison, const AreaResult& result, unsigned threads) {
  const PictureSize size = picture_size(result.area, kCostSide);
  std::vector<std::pair<std::string, CostImage>> maps;
  for (const size_t i : {result.baseline, result.rival}) {
    if (!maps.empty() && i == result.baseline) continue;
    const ComparisonRow& row = comparison.rows[i];
    maps.emplace_back(
        row.name, cost_image(*row.local->tree, *comparison.mesh, result.area, size.width, size.height, {}, threads));
  }
  return heat_maps(maps);
}

}  // namespace

std::vector<AreaResult> area_results(const Comparison& comparison) {
  std::vector<AreaResult> results;
  const size_t count = comparison.rows.size();
  for (size_t begin = 0, end = 0; begin < count; begin = end) {
    for (end = begin + 1; end < count && comparison.rows[end].area == comparison.rows[begin].area;) ++end;
    results.push_back(area_result(comparison, begin, end));
  }
  return results;
}

std::vector<std::string> save_pictures(const Comparison& comparison, std::span<const AreaResult> results,
                                       const std::string& folder, unsigned threads,
                                       const std::function<void(const std::string&, double)>& begin) {
  std::vector<std::string> areas, paths;
  for (const AreaResult& result : results) areas.push_back(result.area.name);
  const std::vector<std::string> names = file_names(areas);
  for (size_t i = 0; i < results.size(); ++i) {
    begin("draw " + names[i], static_cast<double>(i) / static_cast<double>(results.size()));
    paths.push_back(folder + "/" + names[i] + "-depth.png");
    save_png(depth_picture(comparison, results[i], threads), paths.back());
    paths.push_back(folder + "/" + names[i] + "-cost.png");
    save_png(cost_picture(comparison, results[i], threads), paths.back());
  }
  return paths;
}

ReportRow report_row(const ComparisonRow& row) {
  return {row.name, row.area, row.values};
}

}  // namespace raygrain::cli
