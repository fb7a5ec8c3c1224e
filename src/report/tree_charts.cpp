// What kind of trees recipes make: how well they predict their cost, and their shape.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "report/charts.h"

namespace raygrain {

namespace {

std::string tests(const ResultRow& row) {
  const std::string kind = row.kind.empty() ? "all tests" : row.kind + " areas";
  return kind + (row.text("ray_set").empty() ? "" : ", " + std::string(row.text("ray_set")) + " rays");
}

double prediction_error(const ResultRow& row) {
  const double own = row.number("estimated_cost");
  const double estimate = std::isnan(own) ? row.number("estimated_pah") : own;
  return std::abs(row.number("real_cost") / estimate - 1);
}

/// For each kind of tests those that its recipes have in common.
std::vector<ResultRow> with_same_tests(const StudyResults& study) {
  std::vector<ResultRow> rows;
  for (const std::string& kind : distinct(study.rows, tests)) {
    const auto is_of_kind = [&](const ResultRow& row) { return tests(row) == kind; };
    const StudyResults own{study.name, study.id, filtered(study.rows, is_of_kind)};
    const std::vector<ResultRow> same = most_comparable(own.rows, baseline_recipe(own), prediction_error);
    rows.insert(rows.end(), same.begin(), same.end());
  }
  return rows;
}

}  // namespace

/// Errors by recipe and by what was shot: matched rays are those that a measure assumes.
Chart recipe_prediction_chart(const StudyResults& all) {
  Chart chart{.title = "How well trees predict their cost"};
  const StudyResults study{all.name, all.id, with_same_tests(all)};
  if (!any_measured(study.rows, prediction_error)) return chart;
  if (any_measured(study.rows, column_value("pruned_cost"))) {
    ChartPanel paid{.title = "What users pay: pruned cost as a share of the predicted cost",
                    .kind = ChartKind::kRanking,
                    .y = {"mean of pruned cost / predicted cost"},
                    .reference = 1};
    paid.groups = recipe_names(study.rows);
    paid.series = coloured(distinct(study.rows, tests));
    paid.measured = group_means(
        study.rows, [](const ResultRow& row) { return row.recipe; }, tests,
        [](const ResultRow& row) {
          const double own = row.number("estimated_cost");
          return row.number("pruned_cost") / (std::isnan(own) ? row.number("estimated_pah") : own);
        });
    chart.panels.push_back(std::move(paid));
  }
  ChartPanel panel{.title = "Error of the prediction against the full-traversal cost",
                   .kind = ChartKind::kRanking,
                   .y = {"mean of |real - predicted| / predicted"}};
  panel.groups = recipe_names(study.rows);
  panel.series = coloured(distinct(study.rows, tests));
  panel.measured = group_means(
      study.rows, [](const ResultRow& row) { return row.recipe; }, tests, prediction_error);
  std::string text;
  for (const ChartSeries& series : panel.series) {
    const std::vector<ResultRow> rows = filtered(study.rows, [&](const ResultRow& row) {
      return tests(row) == series.name && row.recipe.starts_with("PAH+") && row.text("setting").empty();
    });
    if (any_measured(rows, prediction_error))
      text +=
          fmt::format("{}{} for {}", text.empty() ? "" : ", ", percent(mean_of(rows, prediction_error)), series.name);
  }
  chart.finding = text.empty()
                      ? "No recipe uses PAH."
                      : "Trees of PAH mispredict by " + text + "; the paper gives 2 % for planes and 12 % for points.";
  chart.panels.push_back(std::move(panel));
  for (ChartPanel& shown : chart.panels)  // not all trees have a prediction
    std::erase_if(shown.groups, [&](const std::string& group) {
      return std::none_of(shown.measured.begin(), shown.measured.end(),
                          [&](const ChartPoint& p) { return p.group == group; });
    });
  return chart;
}

namespace {

std::string recipe_of(const ResultRow& row) {
  return row.recipe;
}

ChartPanel paid_ranking(const StudyResults& study, const std::string& baseline) {
  ChartPanel paid{.title = "What users pay: pruned cost as a multiple of " + baseline + "'s",
                  .kind = ChartKind::kRanking,
                  .y = {"geometric mean over tests of recipe / " + baseline},
                  .groups = recipe_names(study.rows),
                  .series = {{"pruned cost", "#d9480f"}},
                  .reference = 1};
  for (const RankedRecipe& r : ranking(study.rows, baseline, column_value("pruned_cost")))
    paid.measured.push_back({.series = "pruned cost",
                             .group = r.recipe,
                             .y = r.ratio.mean,
                             .low = r.ratio.low,
                             .high = r.ratio.high,
                             .count = r.ratio.count});
  return paid;
}

ChartPanel children_dots(const StudyResults& study) {
  ChartPanel children{.title = "Measure of the smaller and the larger child, per parent's",
                      .kind = ChartKind::kDots,
                      .y = {"mean over inner nodes and tests"},
                      .groups = recipe_names(study.rows),
                      .series = {{"smaller child", "#2b7bba"}, {"larger child", "#d9480f"}}};
  children.measured = group_means(
      study.rows, recipe_of, [](const ResultRow&) { return "smaller child"; }, column_value("small_child_ratio"));
  for (ChartPoint& point : group_means(
           study.rows, recipe_of, [](const ResultRow&) { return "larger child"; }, column_value("large_child_ratio")))
    children.measured.push_back(std::move(point));
  return children;
}

ChartPanel depth_ranking(const StudyResults& study) {
  ChartPanel depth{.title = "Depth of the deepest leaf",
                   .kind = ChartKind::kRanking,
                   .y = {"mean number of levels"},
                   .groups = recipe_names(study.rows),
                   .series = {{"deepest leaf", "#868e96"}}};
  depth.measured = group_means(
      study.rows, recipe_of, [](const ResultRow&) { return "deepest leaf"; }, column_value("max_level"));
  return depth;
}

}  // namespace

/// Pruned cost first, then what it may come from: one tiny child beside one nearly as large as its parent.
Chart tree_shape_chart(const StudyResults& all, const std::string& baseline) {
  Chart chart{.title = "Shape of the trees: a small child and a large one"};
  const RowValue level = column_value("max_level");
  if (!any_measured(all.rows, level)) return chart;
  const std::vector<ComparedRecipes> blocks = comparable(all.rows, baseline, level);
  if (blocks.empty()) return chart;
  const StudyResults study{all.name, all.id, blocks.front().rows};
  if (const std::string note = left_out_note(blocks); !note.empty()) chart.notes.push_back(note);
  chart.panels.push_back(paid_ranking(study, baseline));
  if (any_measured(study.rows, column_value("small_child_ratio"))) chart.panels.push_back(children_dots(study));
  chart.panels.push_back(depth_ranking(study));

  const double pah = mean_of(rows_of_recipe(study.rows, "PAH+LSPH"), level),
               sah = mean_of(rows_of_recipe(study.rows, "SAH+LSPH"), level);
  if (std::isnan(pah) || std::isnan(sah)) {
    chart.finding = "The deeper a tree, the smaller its smaller children.";
    return chart;
  }
  chart.label = "Section 9.3";
  chart.verdict = pah > sah ? Verdict::kConfirms : Verdict::kContradicts;
  chart.finding = fmt::format(
      "With PAH+LSPH {}; its trees are {} levels deep in the mean, those of SAH+LSPH {}, where the paper says that "
      "PAH's are deeper.",
      user_sentence(study, "PAH+LSPH", "SAH+LSPH"), short_number(pah), short_number(sah));
  return chart;
}

}  // namespace raygrain
