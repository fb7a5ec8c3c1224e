// Figures 16, 17 and 18 of the paper: what trees of one of its recipes cost, against SAH+LSPH.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "report/charts.h"
#include "report/published.h"

namespace raygrain {

namespace {

constexpr size_t kMostOwnRecipes = 4;  // in one of the paper's figures
constexpr double kEqual = 0.02;        // costs nearer than this agree with either order

struct CostFigure {
  std::string_view label, recipe, title;
};
constexpr std::array<CostFigure, 3> kFigures{{
    {"Figure 16", "PAH+SPFH", "Both heuristics: PAH and SPFH against SAH and LSPH"},
    {"Figure 17", "PAH+LSPH", "PAH alone: PAH and LSPH against SAH and LSPH"},
    {"Figure 18", "SAH+SPFH", "SPFH alone: SAH and SPFH against SAH and LSPH"},
}};

bool is_own_model(const ResultRow& row) {
  const auto end = kPaperScenes.begin() + kOwnModels;
  return std::find(kPaperScenes.begin(), end, row.scene) != end;
}

/// How many of the scenes from `begin` to `end` the rows hold.
size_t scene_count(std::span<const ResultRow> rows, size_t count) {
  return static_cast<size_t>(std::count_if(kPaperScenes.begin(), kPaperScenes.begin() + count, [&](std::string_view s) {
    return std::any_of(rows.begin(), rows.end(), [&](const ResultRow& row) { return row.scene == s; });
  }));
}

double point_value(std::span<const ChartPoint> points, std::string_view series, std::string_view group) {
  for (const ChartPoint& p : points)
    if (p.series == series && p.group == group) return p.y;
  return kNotMeasured;
}

void add_published(ChartPanel& panel, PaperValues PublishedCost::*values, std::string_view label) {
  for (const ChartSeries& series : panel.series) {
    const PublishedCost* cost = published_cost(series.name);
    if (!cost) continue;
    for (ChartPoint& point : published_points(series.name, cost->*values, label))
      if (std::find(panel.groups.begin(), panel.groups.end(), point.group) != panel.groups.end())
        panel.published.push_back(std::move(point));
  }
}

/// Means beside published values, and how far apart they are.
std::string distance_note(const ChartPanel& panel, std::string_view scenes) {
  double sum = 0, most = 0;
  size_t count = 0;
  for (const ChartPoint& published : panel.published) {
    const double apart = std::abs(point_value(panel.measured, published.series, published.group) / published.y - 1);
    if (std::isnan(apart)) continue;
    sum += apart;
    most = std::max(most, apart);
    ++count;
  }
  if (count == 0) return {};
  return fmt::format("Over {}, the means differ from the published ones by {} on average, by {} at most.", scenes,
                     percent(sum / static_cast<double>(count)), percent(most));
}

struct Agreement {
  size_t groups = 0, cheaper = 0, published_cheaper = 0, agreeing = 0;
};

/// Group by group: is the recipe cheaper than the baseline, here and in the paper?
Agreement compare_groups(const ChartPanel& panel, const CostFigure& figure) {
  Agreement result;
  for (size_t i = 0; i < kPaperGroups.size(); ++i) {
    const std::string_view group = kPaperGroups[i].label;
    const double ratio =
        point_value(panel.measured, figure.recipe, group) / point_value(panel.measured, kBaseline, group);
    if (std::isnan(ratio)) continue;
    double published = published_cost(figure.recipe)->eight_scenes[i];
    if (std::isnan(published)) published = published_cost(kMislabelledRecipe)->eight_scenes[i];
    const bool published_cheaper = published < published_cost(kBaseline)->eight_scenes[i];
    ++result.groups;
    result.cheaper += ratio < 1;
    result.published_cheaper += published_cheaper;
    result.agreeing += std::abs(ratio - 1) < kEqual || (ratio < 1) == published_cheaper;
  }
  return result;
}

std::vector<std::string> figure_recipes(const StudyResults& study, const CostFigure& figure) {
  std::vector<std::string> recipes{std::string(figure.recipe)};
  if (figure.recipe == "PAH+LSPH" && !rows_of_recipe(study.rows, kMislabelledRecipe).empty())
    recipes.emplace_back(kMislabelledRecipe);
  recipes.emplace_back(kBaseline);
  std::vector<std::string> own = own_recipes(study);
  own.resize(std::min(own.size(), kMostOwnRecipes));
  recipes.insert(recipes.end(), own.begin(), own.end());
  return recipes;
}

std::string finding(const StudyResults& study, const CostFigure& figure, const Agreement& agreement) {
  const std::string users = user_sentence(study, std::string(figure.recipe), std::string(kBaseline));
  return fmt::format(
      "{}{}y the paper's full-traversal cost {} is cheaper than {} in {} of {} groups, where the paper found {}: the "
      "two "
      "agree on {} of {}.",
      users.empty() ? "" : "With " + std::string(figure.recipe) + " " + users + "; ", users.empty() ? "B" : "b",
      figure.recipe, kBaseline, agreement.cheaper, agreement.groups, agreement.published_cheaper, agreement.agreeing,
      agreement.groups);
}

void add_notes(Chart& chart, const StudyResults& study, const CostFigure& figure) {
  if (figure.recipe == "PAH+LSPH")
    chart.notes.emplace_back(
        "The point half of the published figure was made with another recipe, SAH+SPFH with threshold 0.99; rows named "
        "PAH+LSPH-as-published repeat that. PAH+LSPH itself was never published for points.");
  const size_t own = own_recipes(study).size();
  if (own > kMostOwnRecipes)
    chart.notes.push_back(
        fmt::format("{} more recipes of this study are in the chart of all recipes.", own - kMostOwnRecipes));
}

Chart cost_figure(const StudyResults& study, const CostFigure& figure) {
  Chart chart{.label = std::string(figure.label), .title = std::string(figure.title)};
  const std::vector<std::string> recipes = figure_recipes(study, figure);
  chart.panels = user_bars(study.rows, recipes);
  const RowValue cost = column_value("real_cost");
  ChartPanel all = group_bars(study.rows, recipes, "As in the paper: full-traversal cost",
                              "mean real cost per ray, full traversal", cost);
  const Agreement agreement = compare_groups(all, figure);
  chart.verdict = verdict_of(agreement.agreeing, agreement.groups);
  chart.finding = finding(study, figure, agreement);
  add_published(all, &PublishedCost::eight_scenes, "printed, mean of 8 scenes");

  const size_t scenes = scene_count(study.rows, kPaperScenes.size());
  if (scenes == kPaperScenes.size())
    chart.notes.push_back(distance_note(all, "the eight scenes, two of which are substitutes"));
  else
    chart.notes.push_back(
        fmt::format("{} of the paper's 8 scenes were measured; the published means are over all 8.", scenes));
  chart.panels.push_back(std::move(all));
  if (scene_count(study.rows, kOwnModels) == kOwnModels) {
    ChartPanel six = group_bars(filtered(study.rows, is_own_model), recipes,
                                "The same over the six scenes whose models are the authors' own",
                                "mean real cost per ray, full traversal", cost);
    add_published(six, &PublishedCost::six_scenes, "authors' raw results, mean of 6 scenes");
    chart.notes.push_back(distance_note(six, "the six scenes whose models are the authors' own"));
    chart.panels.push_back(std::move(six));
  }
  std::erase(chart.notes, std::string{});
  add_notes(chart, study, figure);
  return chart;
}

}  // namespace

std::vector<Chart> cost_figures(const StudyResults& study) {
  std::vector<Chart> charts;
  for (const CostFigure& figure : kFigures)
    if (!rows_of_recipe(study.rows, figure.recipe).empty()) charts.push_back(cost_figure(study, figure));
  return charts;
}

}  // namespace raygrain
