// The rows of a results file with their numbers, and the means that charts are made of.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "raygrain/study_report.h"

namespace raygrain {

inline constexpr std::string_view kRecipeColumn = "recipe";

/// A column that the table of fields declares, or one of the studies' own numbers.
bool is_metric(std::string_view column);
bool is_number(std::string_view text);

/// One test: its names and numbers.
struct ResultRow {
  std::string scene, kind, variant, recipe;
  std::map<std::string, std::string, std::less<>> cells;

  /// The cell as it is; empty where there is none.
  std::string_view text(std::string_view column) const;
  /// NaN for what was not measured.
  double number(std::string_view column) const;
};

std::vector<ResultRow> study_rows(const ResultTable& table);

using RowText = std::function<std::string(const ResultRow&)>;
using RowValue = std::function<double(const ResultRow&)>;
RowValue column_value(std::string column);

bool any_measured(std::span<const ResultRow> rows, const RowValue& value);
/// The different values in the order of their first appearance.
std::vector<std::string> distinct(std::span<const ResultRow> rows, const RowText& text);
/// The rows that `keep` keeps.
std::vector<ResultRow> filtered(std::span<const ResultRow> rows, const std::function<bool(const ResultRow&)>& keep);
std::vector<ResultRow> rows_of_recipe(std::span<const ResultRow> rows, std::string_view recipe);

/// The mean of `value` over the rows of each pair of group and series; what was not measured is left out.
std::vector<ChartPoint> group_means(std::span<const ResultRow> rows, const RowText& group, const RowText& series,
                                    const RowValue& value);
double mean_of(std::span<const ResultRow> rows, const RowValue& value);
/// The lower one of two middle values.
double median_of(std::span<const ResultRow> rows, const RowValue& value);

/// What makes two rows the same test of different recipes.
std::string test_key(const ResultRow& row);

/// Tests that two recipes share (all names but the recipe's are equal), compared test by test.
struct PairedRatio {
  double mean = kNotMeasured;  // geometric mean of recipe / baseline
  double low = kNotMeasured, high = kNotMeasured;
  size_t count = 0, less = 0;  // tests; those in which the recipe has less than the baseline
};
PairedRatio paired_ratio(std::span<const ResultRow> rows, std::string_view recipe, std::string_view baseline,
                         const RowValue& value);

/// Pearson's coefficient; NaN below three points.
double correlation(std::span<const std::pair<double, double>> points);

}  // namespace raygrain
