// Many influence areas: octrees of several depths against a list.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "report/charts.h"

namespace raygrain {

namespace {

struct Metric {
  const char* title;
  const char* axis;
  bool logarithmic;
  RowValue value;
};

RowValue nanoseconds(const char* column) {
  return [column](const ResultRow& row) { return row.number(column) * 1e9; };
}

std::vector<Metric> metrics() {
  return {
      {"What users pay: time", "ns per ray", true, nanoseconds_per_ray},
      {"What users pay: pruned cost", "pruned cost per ray, with fallback", false,
       column_value("pruned_cost_with_fallback")},
      {"Time to find the areas of a point", "ns per point", true, nanoseconds("top_level_query_seconds")},
      {"Areas listed that do not hold the point", "mean per point", false, column_value("top_level_false_candidates")},
      {"Time to build the top level", "seconds", true, column_value("top_level_build_seconds")},
      {"Memory of the top level", "bytes", true, column_value("top_level_memory_bytes")}};
}

/// Least time per ray of the list or the octrees over a number of areas.
double least_time(std::span<const ResultRow> rows, double areas, bool list) {
  double least = kNotMeasured;
  for (const ResultRow& row : rows)
    if (const double time = nanoseconds_per_ray(row);
        row.number("areas") == areas && (row.text("top_level") == "list") == list && !(time >= least))
      least = time;
  return least;
}

/// From how many areas on users gain by an octree, in words.
std::string break_even(std::span<const ResultRow> rows) {
  double first = kNotMeasured, most = 0;
  for (const ResultRow& row : rows) {
    const double areas = row.number("areas");
    most = std::max(most, areas);
    if (least_time(rows, areas, false) < least_time(rows, areas, true) && !(areas >= first)) first = areas;
  }
  if (std::isnan(first)) return "Users gain no time by an octree";
  return fmt::format(
      "Users gain time by an octree from {:.0f} areas on: with {:.0f} areas a ray takes {} ns with the best one and {} "
      "ns with the list",
      first, most, short_number(least_time(rows, most, false)), short_number(least_time(rows, most, true)));
}

Chart scene_chart(const StudyResults& study, const std::string& scene) {
  Chart chart{.title = fmt::format("List and octrees over many areas, {}", scene)};
  const std::vector<ResultRow> rows = filtered(study.rows, [&](const ResultRow& row) { return row.scene == scene; });
  for (const Metric& metric : metrics())
    if (any_measured(rows, metric.value))
      chart.panels.push_back(line_panel(rows, metric.title, [](const ResultRow& row) { return row.recipe; },
                                        {ChartAxis{"areas", true}, column_value("areas")},
                                        {ChartAxis{metric.axis, metric.logarithmic}, metric.value}));
  const double saved = mean_of(rows, [](const ResultRow& row) {
    return row.number("pruned_cost_with_fallback") / row.number("global_pruned_cost");
  });
  chart.finding = break_even(rows);
  if (!std::isnan(saved))
    chart.finding += fmt::format(
        "; rays of the areas cost users {} times the pruned cost of one general tree, mean of all numbers of areas",
        short_number(saved));
  chart.finding += ".";
  return chart;
}

}  // namespace

std::vector<Chart> area_charts(const StudyResults& study) {
  std::vector<Chart> charts;
  if (!any_measured(study.rows, column_value("top_level_query_seconds")) &&
      !any_measured(study.rows, column_value("top_level_false_candidates")))
    return charts;
  for (const std::string& scene : distinct(study.rows, [](const ResultRow& row) { return row.scene; }))
    charts.push_back(scene_chart(study, scene));
  return charts;
}

}  // namespace raygrain
