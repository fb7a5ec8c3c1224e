// All recipes of a study against the baseline: what users pay, what the paper counts, and how trees are predicted and
// built.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "report/charts.h"

namespace raygrain {

namespace {

constexpr size_t kMostGroups = 40;  // on one panel

struct Payment {
  const char* series;
  const char* colour;
  RowValue value;
};

/// What is paid, the users' part first.
std::vector<Payment> payments(const StudyResults& study) {
  std::vector<Payment> all{{"pruned cost", "#d9480f", column_value("pruned_cost")},
                           {"time per ray", "#2f9e44", nanoseconds_per_ray},
                           {"full-traversal cost (the paper's)", "#868e96", column_value("real_cost")}};
  std::erase_if(all, [&](const Payment& payment) { return !any_measured(study.rows, payment.value); });
  return all;
}

std::vector<std::string> recipes_of(const StudyResults& study) {
  return recipe_names(study.rows);
}

struct Ranked {
  std::string recipe;
  PairedRatio ratio;
};

/// Recipes by the ratio of what users pay, the best first.
std::vector<Ranked> ranking(const StudyResults& study, const std::string& baseline, const RowValue& value) {
  std::vector<Ranked> ranked;
  for (const std::string& recipe : recipes_of(study))
    if (const PairedRatio ratio = paired_ratio(study.rows, recipe, baseline, value); ratio.count > 0)
      ranked.push_back({recipe, ratio});
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Ranked& a, const Ranked& b) { return a.ratio.mean < b.ratio.mean; });
  return ranked;
}

Chart ranking_chart(const StudyResults& study, const std::string& baseline) {
  Chart chart{.title = "All recipes against " + baseline};
  ChartPanel panel{.title = "Paid per ray, as a multiple of " + baseline + "'s",
                   .kind = ChartKind::kRanking,
                   .y = {"geometric mean over tests of recipe / " + baseline},
                   .reference = 1};
  const std::vector<Payment> paid = payments(study);
  if (paid.empty()) return chart;
  const std::vector<Ranked> ranked = ranking(study, baseline, paid.front().value);
  for (const Ranked& r : ranked) panel.groups.push_back(r.recipe);
  for (const Payment& payment : paid) {
    panel.series.push_back({payment.series, payment.colour});
    for (const Ranked& r : ranking(study, baseline, payment.value))
      panel.measured.push_back({.series = payment.series,
                                .group = r.recipe,
                                .y = r.ratio.mean,
                                .low = r.ratio.low,
                                .high = r.ratio.high,
                                .count = r.ratio.count});
  }
  if (ranked.empty()) return chart;
  const Ranked& best = ranked.front();
  chart.finding = best.recipe == baseline
                      ? fmt::format("No recipe has a lower {} than {} over {} tests.", paid.front().series, baseline,
                                    best.ratio.count)
                      : fmt::format("{} is best: {} times the {} of {} (geometric mean of {} tests, from {} to {}).",
                                    best.recipe, short_number(best.ratio.mean), paid.front().series, baseline,
                                    best.ratio.count, short_number(best.ratio.low), short_number(best.ratio.high));
  chart.panels.push_back(std::move(panel));
  return chart;
}

/// Each recipe's multiple of the baseline in every group of tests.
ChartPanel ratio_dots(const StudyResults& study, const std::string& baseline, const Payment& payment,
                      const RowText& group, std::vector<std::string> groups) {
  ChartPanel panel{.title = std::string(payment.series) + " as a multiple of " + baseline + "'s",
                   .kind = ChartKind::kDots,
                   .y = {"geometric mean over tests of recipe / " + baseline, true},
                   .groups = std::move(groups),
                   .series = coloured(recipes_of(study)),
                   .reference = 1};
  for (const std::string& name : panel.groups) {
    const std::vector<ResultRow> here = filtered(study.rows, [&](const ResultRow& row) { return group(row) == name; });
    for (const ChartSeries& series : panel.series) {
      const PairedRatio ratio = paired_ratio(here, series.name, baseline, payment.value);
      if (ratio.count > 0)
        panel.measured.push_back({.series = series.name,
                                  .group = name,
                                  .y = ratio.mean,
                                  .low = ratio.low,
                                  .high = ratio.high,
                                  .count = ratio.count});
    }
  }
  return panel;
}

/// The best recipe of each group, in words.
std::string winners(const ChartPanel& panel) {
  std::map<std::string, size_t> wins;
  for (const std::string& group : panel.groups) {
    const ChartPoint* best = nullptr;
    for (const ChartPoint& point : panel.measured)
      if (point.group == group && (!best || point.y < best->y)) best = &point;
    if (best) ++wins[best->series];
  }
  std::vector<std::pair<std::string, size_t>> sorted(wins.begin(), wins.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (const auto& [recipe, count] : sorted) text += fmt::format("{}{} in {}", text.empty() ? "" : ", ", recipe, count);
  return text;
}

Chart group_chart(const StudyResults& study, const std::string& baseline, const std::string& title,
                  const RowText& group, const std::vector<std::string>& groups) {
  Chart chart{.title = title};
  for (const Payment& payment : payments(study))
    chart.panels.push_back(ratio_dots(study, baseline, payment, group, groups));
  if (!chart.panels.empty())
    chart.finding = fmt::format("Lowest {} in how many of {}: {}.", payments(study).front().series, groups.size(),
                                winners(chart.panels.front()));
  return chart;
}

double prediction_error(const ResultRow& row) {
  const double own = row.number("estimated_cost");
  const double estimate = std::isnan(own) ? row.number("estimated_pah") : own;
  return std::abs(row.number("real_cost") / estimate - 1);
}

/// Errors by recipe and by what was shot: matched rays are those that a measure assumes.
Chart prediction_chart(const StudyResults& study) {
  Chart chart{.title = "How well trees predict their cost"};
  if (!any_measured(study.rows, prediction_error)) return chart;
  const auto tests = [](const ResultRow& row) {
    const std::string kind = row.kind.empty() ? "all tests" : row.kind + " areas";
    return kind + (row.text("ray_set").empty() ? "" : ", " + std::string(row.text("ray_set")) + " rays");
  };
  if (any_measured(study.rows, column_value("pruned_cost"))) {
    ChartPanel paid{.title = "What users pay: pruned cost as a share of the predicted cost",
                    .kind = ChartKind::kRanking,
                    .y = {"mean of pruned cost / predicted cost"},
                    .reference = 1};
    paid.groups = recipes_of(study);
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
  panel.groups = recipes_of(study);
  panel.series = coloured(distinct(study.rows, tests));
  panel.measured = group_means(
      study.rows, [](const ResultRow& row) { return row.recipe; }, tests, prediction_error);
  std::string text;
  for (const ChartSeries& series : panel.series) {
    const std::vector<ResultRow> rows = filtered(
        study.rows, [&](const ResultRow& row) { return tests(row) == series.name && row.recipe.starts_with("PAH"); });
    if (any_measured(rows, prediction_error))
      text +=
          fmt::format("{}{} for {}", text.empty() ? "" : ", ", percent(mean_of(rows, prediction_error)), series.name);
  }
  chart.finding = text.empty()
                      ? "No recipe uses PAH."
                      : "Trees of PAH mispredict by " + text + "; the paper gives 2 % for planes and 12 % for points.";
  chart.panels.push_back(std::move(panel));
  return chart;
}

/// What users pay with the fallback into the global tree, against using that alone.
Chart fallback_chart(const StudyResults& study) {
  Chart chart{.title = "Local trees with fallback against the global tree alone"};
  const auto ratio = [](const char* column, const char* other) -> RowValue {
    return [=](const ResultRow& row) { return row.number(column) / row.number(other); };
  };
  std::vector<Payment> paid{
      {"pruned cost", "#d9480f", ratio("pruned_cost_with_fallback", "global_pruned_cost")},
      {"full-traversal cost (the paper's)", "#868e96", ratio("cost_with_fallback", "global_cost")}};
  std::erase_if(paid, [&](const Payment& payment) { return !any_measured(study.rows, payment.value); });
  if (paid.empty()) return chart;
  ChartPanel panel{.title = "Paid per ray, as a multiple of the global tree's cost",
                   .kind = ChartKind::kRanking,
                   .y = {"mean over tests"},
                   .groups = recipes_of(study),
                   .reference = 1};
  for (const Payment& payment : paid) {
    panel.series.push_back({payment.series, payment.colour});
    for (ChartPoint& point : group_means(
             study.rows, [](const ResultRow& row) { return row.recipe; },
             [&](const ResultRow&) { return std::string(payment.series); }, payment.value))
      panel.measured.push_back(std::move(point));
  }
  std::string text;
  size_t best = 0, tests = 0;
  for (const std::string& recipe : panel.groups) {
    const std::vector<ResultRow> rows = rows_of_recipe(study.rows, recipe);
    const auto gain = [&](const ResultRow& row) { return paid.front().value(row) < 1; };
    const auto count = static_cast<size_t>(std::count_if(rows.begin(), rows.end(), gain));
    if (!text.empty() && count * tests <= best * rows.size()) continue;
    text = recipe;
    best = count;
    tests = rows.size();
  }
  chart.finding = fmt::format(
      "By {} a local tree with fallback costs less than the global tree alone in {} of {} tests with {}, the recipe "
      "with the largest share.",
      paid.front().series, best, tests, text);
  chart.panels.push_back(std::move(panel));
  return chart;
}

Chart build_chart(const StudyResults& study, const std::string& baseline) {
  Chart chart{.title = "What building costs"};
  const RowValue build = column_value("build_seconds");
  ChartPanel panel{.title = "Time to build, as a multiple of " + baseline + "'s",
                   .kind = ChartKind::kDots,
                   .y = {"geometric mean over tests of recipe / " + baseline, true},
                   .reference = 1};
  const std::vector<Ranked> ranked = ranking(study, baseline, build);
  if (ranked.empty()) return chart;
  panel.series = {{"build time", "#1098ad"}};
  for (const Ranked& r : ranked) {
    panel.groups.push_back(r.recipe);
    panel.measured.push_back({.series = "build time",
                              .group = r.recipe,
                              .y = r.ratio.mean,
                              .low = r.ratio.low,
                              .high = r.ratio.high,
                              .count = r.ratio.count});
  }
  chart.finding = fmt::format(
      "Trees of {} are built fastest ({} times the time of {}), those of {} slowest ({} times).", ranked.front().recipe,
      short_number(ranked.front().ratio.mean), baseline, ranked.back().recipe, short_number(ranked.back().ratio.mean));
  chart.panels.push_back(std::move(panel));
  return chart;
}

}  // namespace

std::vector<Chart> recipe_charts(const StudyResults& all) {
  if (recipes_of(all).size() < 2) return {};
  const StudyResults study{all.name, all.id, main_rays(all.rows)};
  const std::string baseline = baseline_recipe(study);
  std::vector<Chart> charts{ranking_chart(study, baseline), fallback_chart(study)};
  const auto add = [&](const char* title, const RowText& group, const std::vector<std::string>& groups) {
    if (groups.size() > 1 && groups.size() < kMostGroups)
      charts.push_back(group_chart(study, baseline, title, group, groups));
  };
  add("By kind of area and direction of rays", group_label, group_labels(study.rows));
  add(
      "By scene", [](const ResultRow& row) { return row.scene; }, scene_names(study.rows));
  charts.push_back(prediction_chart(all));
  charts.push_back(build_chart(study, baseline));
  std::erase_if(charts, [](const Chart& chart) { return chart.panels.empty(); });
  return charts;
}

}  // namespace raygrain
