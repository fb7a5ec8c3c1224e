// All areas of a scene at once, and rays that belong to none of them.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "report/charts.h"

namespace raygrain {

namespace {

RowValue ratio(const char* column, const char* other) {
  return [=](const ResultRow& row) { return row.number(column) / row.number(other); };
}

std::string recipe_of(const ResultRow& row) {
  return row.recipe;
}

/// "0.939 (no foreign rays) to 1.00 (100 % foreign rays)".
std::string from_to(std::span<const ResultRow> rows, const RowValue& paid) {
  const auto by_share = [](const ResultRow& a, const ResultRow& b) {
    return a.number("foreign_share") < b.number("foreign_share");
  };
  const auto [least, most] = std::minmax_element(rows.begin(), rows.end(), by_share);
  const auto at = [&](double share) {
    return short_number(
        mean_of(filtered(rows, [&](const ResultRow& row) { return row.number("foreign_share") == share; }), paid));
  };
  const double lo = least->number("foreign_share"), hi = most->number("foreign_share");
  return fmt::format("{} ({} foreign rays) to {} ({} foreign rays)", at(lo), percent(lo), at(hi), percent(hi));
}

Chart foreign_chart(const StudyResults& study) {
  Chart chart{.title = "Several areas at once, and rays that none of them knows"};
  const RowValue pruned = ratio("pruned_cost_with_fallback", "global_pruned_cost"),
                 time = ratio("ray_seconds", "global_ray_seconds"), share = column_value("foreign_share");
  const std::pair<ChartAxis, RowValue> x{ChartAxis{"share of foreign rays"}, share};
  const auto add = [&](const char* title, const RowValue& value) {
    if (!any_measured(study.rows, value)) return;
    ChartPanel panel = line_panel(study.rows, title, recipe_of, x,
                                  {ChartAxis{"with areas / the global tree alone, mean over scenes"}, value});
    panel.reference = 1;
    chart.panels.push_back(std::move(panel));
  };
  add("What users pay: pruned cost, with areas against without", pruned);
  add("What users pay: time, with areas against without", time);
  for (const std::string& recipe : distinct(study.rows, recipe_of)) {
    const std::vector<ResultRow> rows = rows_of_recipe(study.rows, recipe);
    chart.finding += fmt::format("{}With {} users pay {} times the pruned cost of the global tree alone",
                                 chart.finding.empty() ? "" : ". ", recipe, from_to(rows, pruned));
    if (any_measured(rows, time)) chart.finding += fmt::format(" and {} times its time", from_to(rows, time));
  }
  chart.finding += ".";
  return chart;
}

/// Hit ratio against the one from which on an area pays, scene by scene, without foreign rays.
Chart break_even_chart(const StudyResults& study) {
  Chart chart{.title = "Hit ratios at which areas pay"};
  const std::vector<ResultRow> rows =
      filtered(study.rows, [](const ResultRow& row) { return row.number("foreign_share") == 0; });
  const RowValue hits = column_value("local_hit_ratio"), needed = column_value("break_even_hit_ratio");
  if (!any_measured(rows, needed)) return chart;
  size_t tests = 0, paying = 0;
  for (const std::string& recipe : distinct(rows, recipe_of)) {
    const std::vector<ResultRow> own = rows_of_recipe(rows, recipe);
    ChartPanel panel{.title = "What users need for a gain: hit ratio and break-even, " + recipe,
                     .kind = ChartKind::kDots,
                     .y = {"share of rays answered by local trees"},
                     .groups = scene_names(own),
                     .series = {{"hit ratio", "#2f9e44"}, {"break-even hit ratio", "#d9480f"}}};
    for (const ResultRow& row : own) {
      panel.measured.push_back({.series = "hit ratio", .group = row.scene, .y = hits(row)});
      panel.measured.push_back({.series = "break-even hit ratio", .group = row.scene, .y = needed(row)});
      ++tests;
      paying += hits(row) > needed(row);
    }
    chart.panels.push_back(std::move(panel));
  }
  chart.finding = fmt::format(
      "Without foreign rays local trees answer more rays than they must for a gain in {} of {} cases.", paying, tests);
  return chart;
}

}  // namespace

std::vector<Chart> stress_charts(const StudyResults& study) {
  if (!any_measured(study.rows, column_value("foreign_share"))) return {};
  std::vector<Chart> charts{foreign_chart(study), break_even_chart(study)};
  std::erase_if(charts, [](const Chart& chart) { return chart.panels.empty(); });
  return charts;
}

}  // namespace raygrain
