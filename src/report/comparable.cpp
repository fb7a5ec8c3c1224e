// Which recipes can be held against each other: means over different tests say nothing of each other.
#include <algorithm>
#include <cmath>
#include <set>

#include "report/charts.h"

namespace raygrain {

namespace {

using Tests = std::set<std::string>;

struct Candidate {
  std::string recipe;
  Tests tests;  // that it shares with the baseline
};

Tests measured_tests(std::span<const ResultRow> rows, std::string_view recipe, const RowValue& value) {
  Tests tests;
  for (const ResultRow& row : rows)
    if (row.recipe == recipe && std::isfinite(value(row))) tests.insert(test_key(row));
  return tests;
}

Tests common(const Tests& a, const Tests& b) {
  Tests both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::inserter(both, both.end()));
  return both;
}

/// Moves those out of `left` that keep at least half of the first one's tests.
std::vector<std::string> take_block(std::vector<Candidate>& left, Tests& tests) {
  tests = left.front().tests;
  const size_t fewest = (tests.size() + 1) / 2;
  std::vector<std::string> recipes;
  std::vector<Candidate> others;
  for (Candidate& candidate : left) {
    Tests both = common(tests, candidate.tests);
    if (both.size() < fewest) {
      others.push_back(std::move(candidate));
      continue;
    }
    tests = std::move(both);
    recipes.push_back(std::move(candidate.recipe));
  }
  left = std::move(others);
  return recipes;
}

}  // namespace

std::vector<ComparedRecipes> comparable(std::span<const ResultRow> rows, const std::string& baseline,
                                        const RowValue& value) {
  const Tests of_baseline = measured_tests(rows, baseline, value);
  std::vector<Candidate> left;
  for (const std::string& recipe : recipe_names(rows))
    if (Tests tests = common(of_baseline, measured_tests(rows, recipe, value)); !tests.empty())
      left.push_back({recipe, std::move(tests)});
  std::stable_sort(left.begin(), left.end(),
                   [](const Candidate& a, const Candidate& b) { return a.tests.size() > b.tests.size(); });
  std::vector<ComparedRecipes> blocks;
  while (!left.empty()) {
    Tests tests;
    std::vector<std::string> recipes = take_block(left, tests);
    if (std::find(recipes.begin(), recipes.end(), baseline) == recipes.end()) recipes.push_back(baseline);
    ComparedRecipes block{{}, tests.size()};
    block.rows = filtered(rows, [&](const ResultRow& row) {
      return std::find(recipes.begin(), recipes.end(), row.recipe) != recipes.end() && tests.contains(test_key(row));
    });
    blocks.push_back(std::move(block));
  }
  return blocks;
}

std::vector<ResultRow> most_comparable(std::span<const ResultRow> rows, const std::string& baseline,
                                       const RowValue& value) {
  std::vector<ComparedRecipes> blocks = comparable(rows, baseline, value);
  return blocks.empty() ? std::vector<ResultRow>{} : std::move(blocks.front().rows);
}

RowValue positive(RowValue value) {
  return [value = std::move(value)](const ResultRow& row) {
    const double number = value(row);
    return number > 0 ? number : kNotMeasured;
  };
}

std::string left_out_note(const std::vector<ComparedRecipes>& blocks) {
  if (blocks.size() < 2) return {};
  std::string names;
  for (size_t i = 1; i < blocks.size(); ++i)
    for (const std::string& recipe : recipe_names(blocks[i].rows))
      if (rows_of_recipe(blocks.front().rows, recipe).empty()) names += (names.empty() ? "" : ", ") + recipe;
  return "Means over different tests say nothing of each other: recipes that share too few tests with the others stand "
         "apart: " +
         names + ".";
}

}  // namespace raygrain
