// Cost, time, build time and memory over the number of triangles.
#include <cmath>

#include <fmt/format.h>

#include "report/charts.h"

namespace raygrain {

namespace {

constexpr size_t kFewestSizes = 3;

struct Metric {
  const char* title;
  const char* axis;
  RowValue value;
};

std::vector<Metric> metrics() {
  return {{"What users pay: pruned cost", "mean pruned cost per ray", column_value("pruned_cost")},
          {"What users pay: time", "mean ns per ray", nanoseconds_per_ray},
          {"The paper's full-traversal cost", "mean real cost per ray, full traversal", column_value("real_cost")},
          {"Time to build", "seconds", column_value("build_seconds")},
          {"Memory", "bytes", column_value("memory_bytes")}};
}

}  // namespace

std::vector<Chart> scaling_charts(const StudyResults& study) {
  const auto scene = [](const ResultRow& row) { return row.scene; };
  const std::vector<std::string> scenes = distinct(study.rows, scene);
  if (has_paper_tests(study) || scenes.size() < kFewestSizes) return {};
  // One size per scene, so that areas which hold a little more or less stand above each other.
  std::map<std::string, double> sizes;
  for (const std::string& name : scenes)
    sizes[name] = mean_of(filtered(study.rows, [&](const ResultRow& row) { return row.scene == name; }),
                          column_value("triangles"));
  const RowValue triangles = [&](const ResultRow& row) { return sizes.at(row.scene); };
  if (!any_measured(study.rows, triangles)) return {};

  Chart chart{.title = "Over the number of triangles"};
  double least = kNotMeasured, most = kNotMeasured;
  std::string largest;
  for (const auto& [name, size] : sizes) {
    if (!(size >= least)) least = size;
    if (!(size <= most)) {
      most = size;
      largest = name;
    }
  }
  for (const Metric& metric : metrics())
    if (any_measured(study.rows, metric.value))
      chart.panels.push_back(line_panel(study.rows, metric.title, [](const ResultRow& row) { return row.recipe; },
                                        {ChartAxis{"triangles in the tree", true}, triangles},
                                        {ChartAxis{metric.axis, true}, metric.value}));
  const std::vector<ResultRow> there =
      most_comparable(filtered(study.rows, [&](const ResultRow& row) { return row.scene == largest; }),
                      baseline_recipe(study), column_value("pruned_cost"));
  std::string best;
  double cost = kNotMeasured;
  for (const std::string& recipe : distinct(there, [](const ResultRow& row) { return row.recipe; }))
    if (const double own = mean_of(rows_of_recipe(there, recipe), column_value("pruned_cost")); !(own >= cost)) {
      cost = own;
      best = recipe;
    }
  chart.finding =
      fmt::format("From {} to {} triangles; at the largest size users pay least with {}: a pruned cost of {} per ray.",
                  fmt::format("{:.0f}", least), fmt::format("{:.0f}", most), best, short_number(cost));
  return {std::move(chart)};
}

}  // namespace raygrain
