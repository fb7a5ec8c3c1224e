// Tables 1 and 2 of the paper: the builder's parameters, and what three of them do.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "raygrain/build.h"

#include "report/charts.h"
#include "report/published.h"

namespace raygrain {

namespace {

struct Parameter {
  const char* paper_name;
  const char* name;
  double published, ours;
};

std::vector<Parameter> parameters() {
  const PaperParameters p;
  return {{"maxLeafCost", "max_leaf_cost", 0, p.max_leaf_cost},
          {"maxLeafArea", "max_leaf_area", 0, p.max_leaf_area},
          {"maxLeafHitProbability", "max_leaf_hit_probability", 0, p.max_leaf_hit_probability},
          {"maxTrianglesPerLeaf", "max_triangles_per_leaf", 2, static_cast<double>(p.max_triangles_per_leaf)},
          {"maxLevels", "max_levels", 100, static_cast<double>(p.max_levels)},
          {"bins", "bins", 40, static_cast<double>(p.bins)},
          {"maxNonFallbackLevels", "max_non_fallback_levels", 100, static_cast<double>(p.max_non_fallback_levels)},
          {"splitPlaneQualityThreshold", "split_plane_quality_threshold", 0.4, p.split_plane_quality_threshold},
          {"acceptableChildrenFatherHitProbabilityRatio", "acceptable_ratio", 1.3, p.acceptable_ratio},
          {"excellentChildrenFatherHitProbabilityRatio", "excellent_ratio", 0.9, p.excellent_ratio}};
}

bool near(double a, double b) {
  return std::abs(a - b) < 1e-6 * std::max(1.0, std::abs(b));
}

std::string case_name(const PublishedTuning& row) {
  return fmt::format("{} / {} / {}", row.quality, row.acceptable, row.excellent);
}

/// Was this parameter left at its default, or not written down?
bool is_default(const ResultRow& row, const char* column, double value) {
  return std::isnan(row.number(column)) || near(row.number(column), value);
}

/// Rows built with PAH+SPFH, a case's three thresholds, and the paper's other parameters.
std::vector<ResultRow> rows_of_case(const StudyResults& study, const PublishedTuning& row) {
  return filtered(study.rows, [&](const ResultRow& r) {
    return is_tuning_row(r) && near(r.number("split_plane_quality_threshold"), row.quality) &&
           near(r.number("acceptable_ratio"), row.acceptable) && near(r.number("excellent_ratio"), row.excellent) &&
           is_default(r, "bins", PaperParameters{}.bins) &&
           is_default(r, "max_non_fallback_levels", PaperParameters{}.max_non_fallback_levels);
  });
}

struct Column {
  const char* title;
  const char* axis;
  const char* column;
  double PublishedTuning::*published;  // null: the paper has none
};
constexpr Column kColumns[] = {
    {"What users pay: pruned cost", "mean pruned cost per ray", "pruned_cost", nullptr},
    {"As in the paper: full-traversal cost", "mean real cost per ray, full traversal", "real_cost",
     &PublishedTuning::cost},
    {"Orientations tried per inner node", "mean orientations per inner node", "orientations_per_node",
     &PublishedTuning::orientations},
    {"Share of inner nodes that fell back", "mean share of inner nodes", "fallback_share",
     &PublishedTuning::fallback_share},
};
constexpr const char* kTuningSeries = "PAH+SPFH";

ChartPanel tuning_panel(const StudyResults& study, const Column& column) {
  ChartPanel panel{.title = column.title, .x = {"quality / acceptable / excellent"}, .y = {column.axis}};
  panel.series = coloured({kTuningSeries});
  for (const PublishedTuning& row : kTable2) {
    panel.groups.push_back(case_name(row));
    const auto group = [&](const ResultRow&) { return case_name(row); };
    for (ChartPoint& point : group_means(
             rows_of_case(study, row), group, [](const ResultRow&) { return std::string(kTuningSeries); },
             column_value(column.column)))
      panel.measured.push_back(std::move(point));
    if (column.published)
      panel.published.push_back({.series = kTuningSeries,
                                 .group = case_name(row),
                                 .y = row.*column.published,
                                 .label = "printed, mean of 64 tests"});
  }
  return panel;
}

/// Of the four changed cases, how many move the cost the way that the paper says?
void judge(Chart& chart, const StudyResults& study, const char* column, std::string& sentence, const char* what) {
  const auto cost = [&](size_t i) { return mean_of(rows_of_case(study, kTable2[i]), column_value(column)); };
  size_t cases = 0, agreeing = 0;
  for (size_t i = 1; i < kTable2.size(); ++i) {
    if (std::isnan(cost(i)) || std::isnan(cost(0))) continue;
    ++cases;
    agreeing += (cost(i) < cost(0)) == (kTable2[i].cost < kTable2[0].cost);
  }
  if (cases == 0) return;
  sentence += fmt::format("{}{} moves the way the paper says in {} of {} changed cases", sentence.empty() ? "" : "; ",
                          what, agreeing, cases);
  if (chart.verdict == Verdict::kMissing) chart.verdict = verdict_of(agreeing, cases);
}

}  // namespace

Chart parameter_table() {
  Chart chart{.id = "table-1", .label = "Table 1", .title = "Parameters of the builder"};
  chart.table.columns = {"in the paper", "in raygrain", "paper", "raygrain's default"};
  size_t same = 0;
  for (const Parameter& p : parameters()) {
    chart.table.rows.push_back({p.paper_name, p.name, fmt::format("{}", p.published), fmt::format("{:.6g}", p.ours)});
    same += near(p.published, p.ours);
  }
  chart.verdict = verdict_of(same, chart.table.rows.size());
  chart.finding = fmt::format("{} of raygrain's {} defaults are the paper's values.", same, chart.table.rows.size());
  chart.notes.emplace_back(
      "The published rows of LSPH were made with a split plane quality threshold of 0.99, which the paper's table does "
      "not "
      "list.");
  chart.notes.emplace_back("A node with fewer triangles than max_triangles_per_leaf is a leaf, so leaves hold one.");
  return chart;
}

Chart tuning_table(const StudyResults& study) {
  Chart chart{.label = "Table 2", .title = "Three thresholds: split plane quality, acceptable and excellent ratio"};
  chart.verdict = Verdict::kMissing;
  chart.table.columns = {"quality",   "acceptable",   "excellent", "pruned cost",    "real cost",
                         "published", "orientations", "published", "fallback share", "published"};
  for (const PublishedTuning& row : kTable2) {
    const std::vector<ResultRow> rows = rows_of_case(study, row);
    const auto mean = [&](const char* column) { return short_number(mean_of(rows, column_value(column))); };
    chart.table.rows.push_back(
        {fmt::format("{}", row.quality), fmt::format("{}", row.acceptable), fmt::format("{}", row.excellent),
         mean("pruned_cost"), mean("real_cost"), fmt::format("{}", row.cost), mean("orientations_per_node"),
         fmt::format("{:.1f}", row.orientations), mean("fallback_share"), fmt::format("{:.2f}", row.fallback_share)});
  }
  std::string sentence;
  judge(chart, study, "pruned_cost", sentence, "The pruned cost, which users pay,");
  chart.verdict = Verdict::kMissing;  // the paper speaks of the other cost
  judge(chart, study, "real_cost", sentence, sentence.empty() ? "The full-traversal cost" : "the full-traversal cost");
  chart.finding = sentence.empty() ? "Not measured here: only the published values are shown. Run raygrain study "
                                     "parameters, and give its results to the report, too."
                                   : sentence + ".";
  if (sentence.empty()) return chart;
  for (const Column& column : kColumns)
    if (any_measured(study.rows, column_value(column.column))) chart.panels.push_back(tuning_panel(study, column));
  chart.notes.push_back(
      fmt::format("Means of {} tests each; the paper's are over 64, two of whose scenes are not public.",
                  rows_of_case(study, kTable2[0]).size()));
  chart.notes.emplace_back(
      "In the authors' final program the last two cases are the other way round: asking for better splits forces more "
      "fallbacks.");
  return chart;
}

}  // namespace raygrain
