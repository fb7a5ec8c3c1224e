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
Agreement compare_groups(const ChartPanel& panel, const CostFigure& figure, PaperValues PublishedCost::*values) {
  Agreement result;
  for (size_t i = 0; i < kPaperGroups.size(); ++i) {
    const std::string_view group = kPaperGroups[i].label;
    const double ratio =
        point_value(panel.measured, figure.recipe, group) / point_value(panel.measured, kBaseline, group);
    if (std::isnan(ratio)) continue;
    double published = (published_cost(figure.recipe)->*values)[i];
    if (std::isnan(published)) published = (published_cost(kMislabelledRecipe)->*values)[i];
    const bool published_cheaper = published < (published_cost(kBaseline)->*values)[i];
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

std::string finding(const StudyResults& study, const CostFigure& figure, const Agreement& agreement, bool six) {
  const std::string users = user_sentence(study, std::string(figure.recipe), std::string(kBaseline));
  std::string text =
      fmt::format("{}{}y the paper's full-traversal cost{} {} is cheaper than {} in {} of {} groups",
                  users.empty() ? "" : "With " + std::string(figure.recipe) + " " + users + "; ",
                  users.empty() ? "B" : "b", six ? ", over the six scenes with the authors' own models," : "",
                  figure.recipe, kBaseline, agreement.cheaper, agreement.groups);
  if (!six)
    return text + fmt::format(
                      ": not comparable with the paper, since only {} of the {} models that are the authors' own "
                      "were measured.",
                      paper_scene_count(study.rows, kOwnModels), kOwnModels);
  return text + fmt::format(", where the paper found {}: the two agree on {} of {}.", agreement.published_cheaper,
                            agreement.agreeing, agreement.groups);
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

/// Means over a set of scenes, with the published ones of the same set.
ChartPanel cost_panel(std::span<const ResultRow> rows, const std::vector<std::string>& recipes,
                      const std::string& title, PaperValues PublishedCost::*values, std::string_view label) {
  ChartPanel panel =
      group_bars(rows, recipes, title, "mean real cost per ray, full traversal", column_value("real_cost"));
  add_published(panel, values, label);
  return panel;
}

Chart cost_figure(const StudyResults& study, const CostFigure& figure) {
  Chart chart{.label = std::string(figure.label), .title = std::string(figure.title)};
  const std::vector<std::string> recipes = figure_recipes(study, figure);
  chart.panels = user_bars(study.rows, recipes);
  const std::string note = scenes_note(study.rows);
  const bool comparable = paper_scene_count(study.rows, kOwnModels) == kOwnModels;
  chart.panels.push_back(cost_panel(study.rows, recipes, "As in the paper: full-traversal cost",
                                    &PublishedCost::eight_scenes, "printed, mean of 8 scenes"));
  chart.notes.push_back(
      note.empty() ? distance_note(chart.panels.back(), "the eight scenes, two of which are substitutes") : note);
  if (comparable) {
    chart.panels.push_back(cost_panel(filtered(study.rows, is_own_model), recipes,
                                      "The same over the six scenes whose models are the authors' own",
                                      &PublishedCost::six_scenes, "authors' raw results, mean of 6 scenes"));
    chart.notes.push_back(distance_note(chart.panels.back(), "the six scenes whose models are the authors' own"));
  }
  // Only the same models can be held against the paper.
  const Agreement agreement = compare_groups(chart.panels.back(), figure,
                                             comparable ? &PublishedCost::six_scenes : &PublishedCost::eight_scenes);
  chart.verdict = comparable ? verdict_of(agreement.agreeing, agreement.groups) : Verdict::kIncomparable;
  chart.finding = finding(study, figure, agreement, comparable);
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
