// What a finished table says, for people.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "raygrain/study.h"

namespace raygrain {
namespace {

/// The columns that a summary needs, by index; empty for other tables.
struct Columns {
  size_t scene, kind, variant, combo, setting, ray_set, real, pruned, fallback;
};

bool is_table_of_trees(const StudyTable& table) {
  return std::find(table.header.begin(), table.header.end(), "real_cost_local") != table.header.end();
}

Columns columns_of(const StudyTable& table) {
  return {table.column("scene"),           table.column("kind"),        table.column("variant"),
          table.column("combo"),           table.column("setting"),     table.column("ray_set"),
          table.column("real_cost_local"), table.column("pruned_cost"), table.column("real_cost_with_fallback")};
}

struct Means {
  size_t rows = 0;
  double real = 0, pruned = 0, fallback = 0;
};

std::string recipe_of(const StudyTable& table, size_t row, const Columns& c) {
  const std::vector<std::string>& cells = table.rows[row];
  return cells[c.combo] + (cells[c.setting].empty() ? "" : ", " + cells[c.setting]);
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
  const Columns c = columns_of(table);
  std::set<std::string> recipes;
  std::map<std::vector<std::string>, std::set<std::string>> tests;
  const auto test_of = [&](size_t row) {
    const std::vector<std::string>& cells = table.rows[row];
    return std::vector<std::string>{cells[c.scene], cells[c.kind], cells[c.variant], cells[c.ray_set]};
  };
  for (size_t row = 0; row < table.rows.size(); ++row) {
    recipes.insert(recipe_of(table, row, c));
    tests[test_of(row)].insert(recipe_of(table, row, c));
  }
  std::map<std::string, Means> means;
  size_t common = 0;
  for (const auto& [test, of_test] : tests) common += of_test.size() == recipes.size() ? 1 : 0;
  for (size_t row = 0; row < table.rows.size(); ++row) {
    if (common > 0 && tests[test_of(row)].size() != recipes.size()) continue;
    Means& m = means[recipe_of(table, row, c)];
    ++m.rows;
    m.real += table.number(row, c.real);
    m.pruned += table.number(row, c.pruned);
    m.fallback += table.number(row, c.fallback);
  }
  std::vector<std::string> lines{
      common > 0 ? fmt::format("means over the {} tests that all recipes have:", common)
                 : std::string("means over each recipe's own tests:"),
      fmt::format("  {:<46} {:>8} {:>8} {:>14}", "recipe", "pruned", "real", "with fallback")};
  for (const auto& [recipe, m] : means) {
    const double n = static_cast<double>(m.rows);
    lines.push_back(
        fmt::format("  {:<46} {:>8.2f} {:>8.2f} {:>14.2f}", recipe, m.pruned / n, m.real / n, m.fallback / n));
  }
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
