// Section 9.6 of the paper: memory, measured, and its own sums done again.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "report/charts.h"

namespace raygrain {

namespace {

constexpr std::string_view kExample = "section 9.6";
constexpr double kSame = 0.05;  // sums nearer than this are the same

struct Part {
  const char* series;
  const char* column;
  const char* colour;
};
constexpr std::array<Part, 4> kParts{{{"global tree", "global_memory_bytes", "#868e96"},
                                      {"local tree", "local_memory_bytes", "#d9480f"},
                                      {"influence area", "area_memory_bytes", "#2b7bba"},
                                      {"top level", "top_level_memory_bytes", "#2f9e44"}}};

RowValue ratio(const char* column, const char* other) {
  return [=](const ResultRow& row) { return row.number(column) / row.number(other); };
}

std::string scene_of(const ResultRow& row) {
  return row.scene;
}

Chart measured_chart(const StudyResults& study) {
  Chart chart{.title = "What one influence area adds to the memory of a scene's tree"};
  const std::vector<ResultRow> rows = filtered(study.rows, [](const ResultRow& row) { return row.scene != kExample; });
  const RowValue total = ratio("total_memory_bytes", "global_memory_bytes"),
                 counted = ratio("total_paper_memory_bytes", "global_paper_memory_bytes");
  if (!any_measured(rows, total)) return chart;

  ChartPanel multiples{.title = "What users pay: memory as a multiple of the global tree's",
                       .kind = ChartKind::kDots,
                       .y = {"total / global tree, mean over areas", true},
                       .groups = scene_names(rows),
                       .series = {{"measured", "#d9480f"}, {"as the paper counts", "#868e96"}},
                       .reference = 1};
  multiples.measured = group_means(
      rows, scene_of, [](const ResultRow&) { return "measured"; }, total);
  for (ChartPoint& point : group_means(
           rows, scene_of, [](const ResultRow&) { return "as the paper counts"; }, counted))
    multiples.measured.push_back(std::move(point));
  chart.panels.push_back(std::move(multiples));

  ChartPanel parts{.title = "Of which parts it consists",
                   .kind = ChartKind::kDots,
                   .y = {"bytes, mean over areas", true},
                   .groups = scene_names(rows)};
  for (const Part& part : kParts) {
    parts.series.push_back({part.series, part.colour});
    for (ChartPoint& point : group_means(
             rows, scene_of, [&](const ResultRow&) { return part.series; }, column_value(part.column)))
      parts.measured.push_back(std::move(point));
  }
  chart.panels.push_back(std::move(parts));
  chart.finding = fmt::format(
      "With one influence area users keep {} times the memory of the global tree, median of {}; as the paper "
      "counts it is {} times.",
      short_number(median_of(rows, total)), raygrain::counted(rows.size(), "area"),
      short_number(median_of(rows, counted)));
  return chart;
}

Chart example_chart(const StudyResults& study) {
  Chart chart{.label = "Section 9.6", .title = "The paper's own example: 21 levels, 1 and 20 areas"};
  const auto megabytes = [](const char* column) {
    return [column](const ResultRow& row) { return row.number(column) / 1e6; };
  };
  const std::vector<ResultRow> rows = filtered(study.rows, [](const ResultRow& row) { return row.scene == kExample; });
  const RowValue published = megabytes("published_memory_bytes"), again = megabytes("total_paper_memory_bytes");
  if (!any_measured(rows, published)) return chart;
  const std::string series = "the same sum done again";
  ChartPanel panel{.title = "What users would pay by the paper's count: memory in all",
                   .y = {"MB"},
                   .groups = distinct(rows, [](const ResultRow& row) { return row.variant; }),
                   .series = {{series, "#d9480f"}}};
  size_t same = 0;
  for (const ResultRow& row : rows) {
    panel.measured.push_back({.series = series, .group = row.variant, .y = again(row)});
    panel.published.push_back(
        {.series = series, .group = row.variant, .y = published(row), .label = "printed in section 9.6"});
    const bool equal = std::abs(published(row) / again(row) - 1) < kSame;
    same += equal;
    chart.finding += fmt::format("{}{}: {:.1f} MB, printed {:.1f} MB", chart.finding.empty() ? "" : "; ", row.variant,
                                 again(row), published(row));
  }
  chart.finding += ".";
  chart.verdict = verdict_of(same, rows.size());
  chart.notes.emplace_back("A full octree of five levels has (8^5 - 1) / 7 = 4681 nodes, not 8^5 - 1.");
  chart.panels.push_back(std::move(panel));
  return chart;
}

}  // namespace

std::vector<Chart> memory_charts(const StudyResults& study) {
  std::vector<Chart> charts{measured_chart(study), example_chart(study)};
  std::erase_if(charts, [](const Chart& chart) { return chart.panels.empty(); });
  return charts;
}

}  // namespace raygrain
