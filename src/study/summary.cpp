// What a finished table says, for people.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "raygrain/study.h"

namespace raygrain {
namespace {

bool is_table_of_trees(const StudyTable& table) {
  return std::find(table.header.begin(), table.header.end(), "real_cost_local") != table.header.end();
}

using Test = std::vector<std::string>;  // scene, kind, variant, ray set

struct RecipeMeans {
  std::string recipe;
  std::set<Test> tests;
  size_t rows = 0;
  double pruned = 0, real = 0, fallback = 0;
};

/// Sorted by the recipes' names.
std::vector<RecipeMeans> means_of_recipes(const StudyTable& table) {
  const size_t combo = table.column("combo"), setting = table.column("setting"), pruned = table.column("pruned_cost"),
               real = table.column("real_cost_local"), fallback = table.column("real_cost_with_fallback");
  std::map<std::string, RecipeMeans> all;
  for (size_t row = 0; row < table.rows.size(); ++row) {
    const std::vector<std::string>& cells = table.rows[row];
    const std::string recipe = cells[combo] + (cells[setting].empty() ? "" : ", " + cells[setting]);
    RecipeMeans& m = all[recipe];
    m.recipe = recipe;
    Test test;
    for (const char* column : {"scene", "kind", "variant", "ray_set"}) test.push_back(cells[table.column(column)]);
    m.tests.insert(std::move(test));
    ++m.rows;
    m.pruned += table.number(row, pruned);
    m.real += table.number(row, real);
    m.fallback += table.number(row, fallback);
  }
  std::vector<RecipeMeans> means;
  means.reserve(all.size());
  for (auto& [recipe, m] : all) means.push_back(std::move(m));
  return means;
}

/// Means over other tests than a recipe's own cannot be held against its: recipes with the same tests stand together,
/// those with the most first.
std::vector<std::vector<const RecipeMeans*>> by_tests(const std::vector<RecipeMeans>& means) {
  std::vector<std::vector<const RecipeMeans*>> blocks;
  for (const RecipeMeans& m : means) {
    const auto same = [&](const auto& block) { return block.front()->tests == m.tests; };
    const auto block = std::find_if(blocks.begin(), blocks.end(), same);
    if (block != blocks.end())
      block->push_back(&m);
    else
      blocks.push_back({&m});
  }
  std::stable_sort(blocks.begin(), blocks.end(),
                   [](const auto& a, const auto& b) { return a.front()->tests.size() > b.front()->tests.size(); });
  return blocks;
}

void add_means(std::vector<std::string>& lines, const std::vector<RecipeMeans>& means) {
  const auto blocks = by_tests(means);
  for (const auto& block : blocks) {
    const size_t tests = block.front()->tests.size();
    lines.push_back(
        blocks.size() == 1
            ? fmt::format("means over the {} tests of all recipes:", tests)
            : fmt::format("means over the {} tests of these recipes, not to be held against others:", tests));
    lines.push_back(fmt::format("  {:<46} {:>8} {:>8} {:>14}", "recipe", "pruned", "real", "with fallback"));
    for (const RecipeMeans* m : block) {
      const auto n = static_cast<double>(m->rows);
      lines.push_back(
          fmt::format("  {:<46} {:>8.2f} {:>8.2f} {:>14.2f}", m->recipe, m->pruned / n, m->real / n, m->fallback / n));
    }
  }
}

}  // namespace

double prediction_error(const StudyTable& table, const std::string& estimate, const std::string& kind,
                        const std::string& combo, const std::string& ray_set) {
  const size_t real = table.column("real_cost_local"), estimated = table.column(estimate);
  const auto is = [&](size_t row, const char* column, const std::string& text) {
    return text.empty() || table.rows[row][table.column(column)] == text;
  };
  double sum = 0;
  size_t count = 0;
  for (size_t row = 0; row < table.rows.size(); ++row) {
    if (!is(row, "kind", kind) || !is(row, "combo", combo) || !is(row, "ray_set", ray_set)) continue;
    const double e = table.number(row, estimated), error = std::abs(table.number(row, real) - e) / e;
    if (!std::isfinite(error)) continue;
    sum += error;
    ++count;
  }
  return count == 0 ? std::nan("") : sum / static_cast<double>(count);
}

std::vector<std::string> study_summary(const StudyTable& table) {
  if (!is_table_of_trees(table) || table.rows.empty()) return {};
  std::vector<std::string> lines;
  add_means(lines, means_of_recipes(table));
  for (const char* kind : {"plane", "point"})
    for (const char* rays : {"matched", "angular", "published"}) {
      const double pah = prediction_error(table, "estimated_pah", kind, {}, rays);
      if (std::isnan(pah)) continue;
      const double sah = prediction_error(table, "estimated_sah", kind, {}, rays);
      lines.push_back(fmt::format("prediction error, {} areas, {} rays: PAH {:.2f} %, SAH {:.2f} %", kind, rays,
                                  100 * pah, 100 * sah));
    }
  return lines;
}

}  // namespace raygrain
