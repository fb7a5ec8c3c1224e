// The charts of one study, and what they share. Each function returns the charts that the rows hold values for.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "raygrain/chart.h"

#include "report/study_data.h"

namespace raygrain {

struct StudyResults {
  std::string name, id;
  std::vector<ResultRow> rows;
  std::string baseline = {};  // asked for; baseline_recipe() where it is not there
};

inline constexpr std::string_view kBaseline = "SAH+LSPH";

// The paper's figures 14, 16, 17, 18, 19, 20 and 22 (paper_*.cpp).
Chart prediction_figure(const StudyResults& study);
std::vector<Chart> cost_figures(const StudyResults& study);
Chart split_time_figure(const StudyResults& study);
Chart overlap_cost_figure(const StudyResults& study);
Chart overlap_figure(const StudyResults& study);
// Its tables.
Chart parameter_table();
Chart tuning_table(const StudyResults& study);
/// Figures, tables and studies that `sections` do not hold, each with the command that makes it; no rows where all are
/// there.
Chart missing_charts(std::span<const ChartSection> sections);

/// All recipes against the baseline: pruned cost, time, full cost; by group, by scene; prediction; building.
std::vector<Chart> recipe_charts(const StudyResults& study);
/// Of those: errors by recipe and by what was shot, and the shape of the trees.
Chart recipe_prediction_chart(const StudyResults& study);
Chart tree_shape_chart(const StudyResults& study, const std::string& baseline);

/// Rows of recipes over the tests that all of them, the baseline among them, have in common.
struct ComparedRecipes {
  std::vector<ResultRow> rows;
  size_t tests = 0;
};
/// All recipes that share tests with the baseline, in as few sets as can be held against each other: each set keeps at
/// least half of the tests that its most tested recipe shares with the baseline. The largest first. A test counts for a
/// recipe where `value` is a number.
std::vector<ComparedRecipes> comparable(std::span<const ResultRow> rows, const std::string& baseline,
                                        const RowValue& value);
/// The rows of the first of these sets.
std::vector<ResultRow> most_comparable(std::span<const ResultRow> rows, const std::string& baseline,
                                       const RowValue& value);
/// NaN for what is not above zero and has no geometric mean.
RowValue positive(RowValue value);
/// Which recipes are not in the first set; empty where all are.
std::string left_out_note(const std::vector<ComparedRecipes>& blocks);

struct RankedRecipe {
  std::string recipe;
  PairedRatio ratio;
};
/// Recipes by their ratio to the baseline over the tests that all of them have (most_comparable), the best first.
std::vector<RankedRecipe> ranking(std::span<const ResultRow> rows, const std::string& baseline, const RowValue& value);

/// Is it a row of the paper's combination PAH+SPFH, whatever its parameters?
bool is_tuning_row(const ResultRow& row);

// What the paper called for, or left at an estimate: nothing where the study holds no such rows.
std::vector<Chart> parameter_charts(const StudyResults& study);
std::vector<Chart> area_charts(const StudyResults& study);
std::vector<Chart> memory_charts(const StudyResults& study);
std::vector<Chart> scaling_charts(const StudyResults& study);
std::vector<Chart> stress_charts(const StudyResults& study);

/// Does the study hold the paper's tests (kinds, variants, the baseline and another of its recipes)?
bool has_paper_tests(const StudyResults& study);

/// The label of a row's group: the paper's, or what kind, variant and area say.
std::string group_label(const ResultRow& row);
/// Groups that occur, the paper's first, in its order.
std::vector<std::string> group_labels(std::span<const ResultRow> rows);

/// Recipes and scenes that occur, the paper's first, in its order.
std::vector<std::string> recipe_names(std::span<const ResultRow> rows);
std::vector<std::string> scene_names(std::span<const ResultRow> rows);

/// How many of the first `count` of the paper's scenes the rows hold.
size_t paper_scene_count(std::span<const ResultRow> rows, size_t count);
/// "5 of the paper's 8 scenes were measured ..."; empty where all were.
std::string scenes_note(std::span<const ResultRow> rows);

/// " It rests on 5 scenes, 5 of the paper's 8.": the end of a finding.
std::string scenes_sentence(std::span<const ResultRow> rows);

/// A chart over a number: means of `value` over the rows of each series at each x.
ChartPanel line_panel(std::span<const ResultRow> rows, const std::string& title, const RowText& series,
                      const std::pair<ChartAxis, RowValue>& x, const std::pair<ChartAxis, RowValue>& y);

/// The rows of the rays that match the areas' own distribution, where a study has several ray sets.
std::vector<ResultRow> main_rays(std::span<const ResultRow> rows);

/// Recipes of the study that the paper does not have, in order: a researcher's own.
std::vector<std::string> own_recipes(const StudyResults& study);
/// PAH+SPFH with the paper's own parameters; empty where it is not there.
std::string default_recipe(const StudyResults& study);
/// The one that was asked for, SAH+LSPH where that is not there, else what looks most like it, PAH+SPFH with the
/// paper's parameters, or any.
std::string baseline_recipe(const StudyResults& study);

/// Series with a colour each: a recipe of the paper has the same in every chart, the baseline is grey.
std::vector<ChartSeries> coloured(const std::vector<std::string>& names);

/// The time of a ray in nanoseconds; NaN where it was not measured.
double nanoseconds_per_ray(const ResultRow& row);

/// Upright bars of means in the paper's groups, one series per recipe.
ChartPanel group_bars(std::span<const ResultRow> rows, const std::vector<std::string>& recipes,
                      const std::string& title, const std::string& axis, const RowValue& value);
/// What users pay, as such bars: pruned cost, then time where it was measured.
std::vector<ChartPanel> user_bars(std::span<const ResultRow> rows, const std::vector<std::string>& recipes);

/// "1.35 times", "0.94 times"; three significant digits elsewhere: "0.0123", "12.3", "1234".
std::string short_number(double value);
std::string percent(double share);
/// "1 test", "64 tests".
std::string counted(size_t count, std::string_view thing);
/// One sentence on what users pay: pruned cost, and time where it was measured, against the baseline.
std::string user_sentence(const StudyResults& study, const std::string& recipe, const std::string& baseline);

/// `agreeing` of `all` statements of the paper were found true.
Verdict verdict_of(size_t agreeing, size_t all);

/// Small letters, digits and - of a text.
std::string id_of(std::string_view text);

}  // namespace raygrain
