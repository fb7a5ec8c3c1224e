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
constexpr size_t kMostDots = 6;     // on one line: more recipes are told apart by numbers

struct Payment {
  const char* title;
  const char* series;
  const char* colour;
  RowValue value;
};

/// What is paid, the users' part first.
std::vector<Payment> payments(const StudyResults& study) {
  std::vector<Payment> all{
      {"What users pay: pruned cost", "pruned cost", "#d9480f", column_value("pruned_cost")},
      {"What users pay: time", "time per ray", "#2f9e44", nanoseconds_per_ray},
      {"What users pay: time, rays one at a time", "time per ray, one at a time", "#66a80f",
       column_value("single_ray_seconds")},
      {"The paper's full-traversal cost", "full-traversal cost (the paper's)", "#868e96", column_value("real_cost")}};
  std::erase_if(all, [&](const Payment& payment) { return !any_measured(study.rows, payment.value); });
  return all;
}

ChartPoint point_of(const RankedRecipe& ranked, const char* series) {
  return {.series = series,
          .group = ranked.recipe,
          .y = ranked.ratio.mean,
          .low = ranked.ratio.low,
          .high = ranked.ratio.high,
          .count = ranked.ratio.count};
}

/// All recipes of a block, the best first by what is paid first.
ChartPanel ranking_panel(const ComparedRecipes& block, const std::string& baseline, const std::vector<Payment>& paid) {
  ChartPanel panel{.title = fmt::format("Paid per ray, as a multiple of {}'s, over {} that all of these have", baseline,
                                        counted(block.tests, "test")),
                   .kind = ChartKind::kRanking,
                   .y = {"geometric mean over tests of recipe / " + baseline},
                   .reference = 1};
  for (const RankedRecipe& r : ranking(block.rows, baseline, paid.front().value)) panel.groups.push_back(r.recipe);
  for (const Payment& payment : paid) {
    panel.series.push_back({payment.series, payment.colour});
    for (const RankedRecipe& r : ranking(block.rows, baseline, payment.value))
      panel.measured.push_back(point_of(r, payment.series));
  }
  return panel;
}

/// In how many tests each recipe is cheaper than the baseline.
ChartTable win_table(const ComparedRecipes& block, const std::string& baseline, const std::vector<Payment>& paid) {
  ChartTable table{{"recipe"}, {}};
  for (const Payment& payment : paid) table.columns.push_back(std::string("less ") + payment.series);
  for (const RankedRecipe& r : ranking(block.rows, baseline, paid.front().value)) {
    std::vector<std::string>& cells = table.rows.emplace_back(1, r.recipe);
    for (const Payment& payment : paid) {
      const PairedRatio ratio = paired_ratio(block.rows, r.recipe, baseline, payment.value);
      cells.push_back(ratio.count == 0 ? "-" : fmt::format("in {} of {}", ratio.less, counted(ratio.count, "test")));
    }
  }
  return table;
}

Chart ranking_chart(const StudyResults& study, const std::string& baseline) {
  Chart chart{.title = "All recipes against " + baseline};
  const std::vector<Payment> paid = payments(study);
  if (paid.empty()) return chart;
  const std::vector<ComparedRecipes> blocks = comparable(study.rows, baseline, positive(paid.front().value));
  if (blocks.empty()) return chart;
  for (const ComparedRecipes& block : blocks) chart.panels.push_back(ranking_panel(block, baseline, paid));
  const std::vector<RankedRecipe> ranked = ranking(blocks.front().rows, baseline, paid.front().value);
  chart.table = win_table(blocks.front(), baseline, paid);
  const RankedRecipe& best = ranked.front();
  chart.finding =
      best.recipe == baseline
          ? fmt::format("No recipe has a lower {} than {} over {}.", paid.front().series, baseline,
                        counted(best.ratio.count, "test"))
          : fmt::format("{} is best: {} times the {} of {} (geometric mean of {}, from {} to {}).", best.recipe,
                        short_number(best.ratio.mean), paid.front().series, baseline, counted(best.ratio.count, "test"),
                        short_number(best.ratio.low), short_number(best.ratio.high));
  if (paid.size() > 1 && std::string_view(paid[1].series) == "time per ray")
    if (const std::vector<RankedRecipe> timed = ranking(blocks.front().rows, baseline, paid[1].value); !timed.empty())
      chart.finding += fmt::format(" In time {} is best: {} times that of {}.", timed.front().recipe,
                                   short_number(timed.front().ratio.mean), baseline);
  if (const std::string note = left_out_note(blocks); !note.empty()) chart.notes.push_back(note);
  const auto is_single = [](const ResultRow& row) {
    return !std::isnan(row.number("single_ray_seconds")) && std::isnan(nanoseconds_per_ray(row));
  };
  if (std::any_of(study.rows.begin(), study.rows.end(), is_single))
    chart.notes.emplace_back(
        "Trees in ray space are searched one ray at a time, where other trees take arrays of rays: only times of rays "
        "one "
        "at a time can be held against each other.");
  return chart;
}

/// Each recipe's multiple of the baseline in every group of tests.
ChartPanel ratio_dots(const StudyResults& study, const std::string& baseline, const Payment& payment,
                      const RowText& group, std::vector<std::string> groups) {
  ChartPanel panel{.title = payment.title + (" as a multiple of " + baseline + "'s"),
                   .kind = recipe_names(study.rows).size() > kMostDots ? ChartKind::kMatrix : ChartKind::kDots,
                   .y = {"geometric mean over tests of recipe / " + baseline, true},
                   .groups = std::move(groups),
                   .series = coloured(recipe_names(study.rows)),
                   .reference = 1};
  for (const std::string& name : panel.groups) {
    const std::vector<ResultRow> here =
        most_comparable(filtered(study.rows, [&](const ResultRow& row) { return group(row) == name; }), baseline,
                        positive(payment.value));
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
  for (const auto& [recipe, count] : sorted)
    text += fmt::format("{}with {} in {}", text.empty() ? "" : ", ", recipe, count);
  return text;
}

Chart group_chart(const StudyResults& study, const std::string& baseline, const std::string& title,
                  const RowText& group, const std::vector<std::string>& groups) {
  Chart chart{.title = title};
  for (const Payment& payment : payments(study))
    chart.panels.push_back(ratio_dots(study, baseline, payment, group, groups));
  if (!chart.panels.empty())
    chart.finding = fmt::format("Of {} groups the {} is lowest {}.", groups.size(), payments(study).front().series,
                                winners(chart.panels.front()));
  return chart;
}

/// What users pay with the fallback into the global tree, against using that alone.
Chart fallback_chart(const StudyResults& all, const std::string& baseline) {
  Chart chart{.title = "Local trees with fallback against the global tree alone"};
  const auto ratio = [](const char* column, const char* other) -> RowValue {
    return [=](const ResultRow& row) { return row.number(column) / row.number(other); };
  };
  std::vector<Payment> paid{
      {"", "pruned cost", "#d9480f", ratio("pruned_cost_with_fallback", "global_pruned_cost")},
      {"", "full-traversal cost (the paper's)", "#868e96", ratio("cost_with_fallback", "global_cost")}};
  std::erase_if(paid, [&](const Payment& payment) { return !any_measured(all.rows, payment.value); });
  if (paid.empty()) return chart;
  const std::vector<ComparedRecipes> blocks = comparable(all.rows, baseline, paid.front().value);
  if (blocks.empty()) return chart;
  const std::vector<ResultRow>& compared = blocks.front().rows;
  if (const std::string note = left_out_note(blocks); !note.empty()) chart.notes.push_back(note);
  ChartPanel panel{.title = "Paid per ray, as a multiple of the global tree's cost",
                   .kind = ChartKind::kRanking,
                   .y = {"mean over tests"},
                   .groups = recipe_names(compared),
                   .reference = 1};
  for (const Payment& payment : paid) {
    panel.series.push_back({payment.series, payment.colour});
    for (ChartPoint& point : group_means(
             compared, [](const ResultRow& row) { return row.recipe; },
             [&](const ResultRow&) { return std::string(payment.series); }, payment.value))
      panel.measured.push_back(std::move(point));
  }
  std::string text;
  size_t best = 0, tests = 0;
  for (const std::string& recipe : panel.groups) {
    const std::vector<ResultRow> rows = rows_of_recipe(compared, recipe);
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
  const std::vector<RankedRecipe> ranked = ranking(study.rows, baseline, build);
  if (ranked.empty()) return chart;
  panel.series = {{"build time", "#1098ad"}};
  for (const RankedRecipe& r : ranked) {
    panel.groups.push_back(r.recipe);
    panel.measured.push_back(point_of(r, "build time"));
  }
  if (const std::string note = left_out_note(comparable(study.rows, baseline, positive(build))); !note.empty())
    chart.notes.push_back(note);
  chart.finding = fmt::format(
      "Trees of {} are built fastest ({} times the time of {}), those of {} slowest ({} times).", ranked.front().recipe,
      short_number(ranked.front().ratio.mean), baseline, ranked.back().recipe, short_number(ranked.back().ratio.mean));
  chart.panels.push_back(std::move(panel));
  return chart;
}

}  // namespace

std::vector<Chart> recipe_charts(const StudyResults& all) {
  if (recipe_names(all.rows).size() < 2) return {};
  const StudyResults study{all.name, all.id, main_rays(all.rows), all.baseline};
  const std::string baseline = baseline_recipe(study);
  std::vector<Chart> charts{ranking_chart(study, baseline), fallback_chart(study, baseline)};
  const auto add = [&](const char* title, const RowText& group, const std::vector<std::string>& groups) {
    if (groups.size() > 1 && groups.size() < kMostGroups)
      charts.push_back(group_chart(study, baseline, title, group, groups));
  };
  add("By kind of area and direction of rays", group_label, group_labels(study.rows));
  add(
      "By scene", [](const ResultRow& row) { return row.scene; }, scene_names(study.rows));
  charts.push_back(recipe_prediction_chart(all));
  charts.push_back(tree_shape_chart(study, baseline));
  charts.push_back(build_chart(study, baseline));
  std::erase_if(charts, [](const Chart& chart) { return chart.panels.empty(); });
  return charts;
}

}  // namespace raygrain
