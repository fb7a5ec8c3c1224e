// A finer grid than the paper's table 2: its three thresholds, the bins, and the levels that use the primary
// heuristics.
#include <cmath>

#include <fmt/format.h>

#include "raygrain/build.h"

#include "report/charts.h"

namespace raygrain {

namespace {

std::string plain_number(double value) {
  return fmt::format("{:.6g}", value);
}

bool is(const ResultRow& row, const char* column, double value) {
  return std::abs(row.number(column) - value) < 1e-6;
}

bool has_default_thresholds(const ResultRow& row) {
  return is(row, "split_plane_quality_threshold", 0.4) && is(row, "acceptable_ratio", 1.3) &&
         is(row, "excellent_ratio", 0.9);
}
bool has_default_bins(const ResultRow& row) {
  return is(row, "bins", PaperParameters{}.bins);
}
bool has_default_levels(const ResultRow& row) {
  return is(row, "max_non_fallback_levels", PaperParameters{}.max_non_fallback_levels);
}

struct Metric {
  const char* title;
  const char* series;
  RowValue value;
};
std::vector<Metric> metrics() {
  return {{"What users pay: pruned cost", "pruned cost", column_value("pruned_cost")},
          {"What users pay: time", "time per ray", nanoseconds_per_ray},
          {"As in the paper: full-traversal cost", "full-traversal cost", column_value("real_cost")},
          {"What building costs: time", "build time", column_value("build_seconds")}};
}

constexpr const char* kAxis = "multiple of the paper's parameters, geometric mean";
constexpr size_t kFewestSettings = 3;  // on a line

ChartPoint ratio_point(const std::string& series, double x, const PairedRatio& ratio) {
  return {.series = series, .x = x, .y = ratio.mean, .low = ratio.low, .high = ratio.high, .count = ratio.count};
}

/// The three thresholds, each with each: a panel per metric, a line per pair of ratios.
Chart threshold_chart(const StudyResults& study, const std::string& baseline) {
  Chart chart{.title = "The three thresholds, each with each"};
  const std::vector<ResultRow> rows =
      filtered(study.rows, [](const ResultRow& row) { return has_default_bins(row) && has_default_levels(row); });
  const auto pair = [](const ResultRow& row) {
    return fmt::format("acceptable {}, excellent {}", plain_number(row.number("acceptable_ratio")),
                       plain_number(row.number("excellent_ratio")));
  };
  double best = kNotMeasured;
  for (const Metric& metric : metrics()) {
    const auto blocks = comparable(rows, baseline, positive(metric.value));
    if (blocks.empty()) continue;
    if (chart.panels.empty()) chart.notes.push_back(left_out_note(blocks));
    const std::vector<ResultRow>& compared = blocks.front().rows;
    ChartPanel panel{.title = metric.title,
                     .kind = ChartKind::kLines,
                     .x = {"split plane quality threshold"},
                     .y = {kAxis},
                     .reference = 1};
    panel.series = coloured(distinct(compared, pair));
    for (const std::string& recipe : distinct(compared, [](const ResultRow& row) { return row.recipe; })) {
      const std::vector<ResultRow> own = rows_of_recipe(compared, recipe);
      const PairedRatio ratio = paired_ratio(compared, recipe, baseline, metric.value);
      panel.measured.push_back(
          ratio_point(pair(own.front()), own.front().number("split_plane_quality_threshold"), ratio));
      if (chart.panels.empty() && !(ratio.mean >= best)) {
        best = ratio.mean;
        chart.finding = fmt::format(
            "Users pay least with quality {}, {}: {} times the pruned cost of the paper's parameters over {}.",
            plain_number(own.front().number("split_plane_quality_threshold")), pair(own.front()),
            short_number(ratio.mean), counted(ratio.count, "test"));
      }
    }
    chart.panels.push_back(std::move(panel));
  }
  std::erase(chart.notes, std::string{});
  return chart;
}

/// One parameter alone: all metrics in one panel.
Chart single_chart(std::span<const ResultRow> rows, const std::string& baseline, const char* title,
                   const char* column) {
  Chart chart{.title = title};
  ChartPanel panel{.title = "Pruned cost and time first; the paper's full-traversal cost beside them",
                   .kind = ChartKind::kLines,
                   .x = {title},
                   .y = {kAxis},
                   .reference = 1};
  const auto setting = [&](const ResultRow& row) { return std::string(row.text(column)); };
  if (distinct(rows, setting).size() < kFewestSettings) return chart;
  std::vector<std::string> names;
  double best = kNotMeasured;
  for (const Metric& metric : metrics()) {
    const auto blocks = comparable(rows, baseline, positive(metric.value));
    if (blocks.empty()) continue;
    names.emplace_back(metric.series);
    if (names.size() == 1) chart.notes.push_back(left_out_note(blocks));
    const std::vector<ResultRow>& compared = blocks.front().rows;
    for (const std::string& recipe : distinct(compared, [](const ResultRow& row) { return row.recipe; })) {
      const PairedRatio ratio = paired_ratio(compared, recipe, baseline, metric.value);
      const double x = rows_of_recipe(compared, recipe).front().number(column);
      panel.measured.push_back(ratio_point(metric.series, x, ratio));
      if (names.size() > 1 || ratio.mean >= best) continue;
      best = ratio.mean;
      chart.finding =
          fmt::format("The {} is lowest with {}: {} times that of the paper's parameters over {}.", metric.series,
                      plain_number(x), short_number(ratio.mean), counted(ratio.count, "test"));
    }
  }
  if (names.empty()) return chart;
  std::erase(chart.notes, std::string{});
  panel.series = coloured(names);
  chart.panels.push_back(std::move(panel));
  return chart;
}

}  // namespace

bool is_tuning_row(const ResultRow& row) {
  constexpr std::string_view kTuned = "PAH+SPFH";
  const std::string_view recipe = row.text(kRecipeColumn);
  return recipe.starts_with(kTuned) && (recipe.size() == kTuned.size() || recipe[kTuned.size()] == '@');
}

std::string default_recipe(const StudyResults& study) {
  for (const ResultRow& row : study.rows)
    if (is_tuning_row(row) && has_default_thresholds(row) && has_default_bins(row) && has_default_levels(row))
      return row.recipe;
  return {};
}

std::vector<Chart> parameter_charts(const StudyResults& all) {
  const StudyResults study{all.name, all.id, filtered(main_rays(all.rows), is_tuning_row)};
  const std::string baseline = default_recipe(study);
  const std::vector<ResultRow> bins =
      filtered(study.rows, [](const ResultRow& row) { return has_default_thresholds(row) && has_default_levels(row); });
  const std::vector<ResultRow> levels =
      filtered(study.rows, [](const ResultRow& row) { return has_default_thresholds(row) && has_default_bins(row); });
  std::vector<Chart> charts{
      threshold_chart(study, baseline), single_chart(bins, baseline, "Slices per axis (bins)", "bins"),
      single_chart(levels, baseline, "Levels that use PAH and SPFH (maxNonFallbackLevels)", "max_non_fallback_levels")};
  std::erase_if(charts, [](const Chart& chart) { return chart.panels.empty(); });
  return charts;
}

}  // namespace raygrain
