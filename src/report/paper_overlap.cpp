// Figures 20 and 22 of the paper: overlap of siblings, and what it costs.
#include <cmath>

#include <fmt/format.h>

#include "report/charts.h"
#include "report/published.h"

namespace raygrain {

namespace {

constexpr std::string_view kFull = "PAH+SPFH";
constexpr const char* kOverlapColumn = "overlap4_culled";

/// A point per test: the means over its seeds and repeats, which are no tests of their own.
std::vector<std::pair<double, double>> pairs_of(std::span<const ResultRow> rows, const char* x, const char* y) {
  const std::vector<ResultRow> measured =
      filtered(rows, [&](const ResultRow& row) { return !std::isnan(row.number(x)) && !std::isnan(row.number(y)); });
  const auto test = [](const ResultRow& row) { return row.scene + '\n' + group_label(row); };
  const auto means = [&](const char* column) {
    return group_means(
        measured, test, [](const ResultRow&) { return std::string{}; }, column_value(column));
  };
  const std::vector<ChartPoint> xs = means(x), ys = means(y);
  std::vector<std::pair<double, double>> points;
  for (size_t i = 0; i < xs.size(); ++i) points.emplace_back(xs[i].y, ys[i].y);
  return points;
}

struct Related {
  double correlation = kNotMeasured;
  bool significant = false;  // at 95 %, by Fisher's transformation
};

Related related(std::span<const std::pair<double, double>> points, size_t means_removed) {
  const double r = correlation(points);
  const auto left = static_cast<double>(points.size()) - static_cast<double>(means_removed) - 2;
  return {r, left > 0 && r < 1 && std::atanh(r) * std::sqrt(left) > 1.96};
}

/// Scenes differ in both; what overlap does to cost shows where each scene's own means are removed. Costs multiply, so
/// their logarithms are taken.
Related related_within_scenes(std::span<const ResultRow> rows) {
  std::vector<std::pair<double, double>> points;
  const std::vector<std::string> scenes = scene_names(rows);
  for (const std::string& scene : scenes) {
    auto own =
        pairs_of(filtered(rows, [&](const ResultRow& row) { return row.scene == scene; }), kOverlapColumn, "real_cost");
    std::erase_if(own, [](const auto& point) { return !(point.second > 0); });
    double mean_x = 0, mean_y = 0;
    for (auto& [x, y] : own) {
      y = std::log(y);
      mean_x += x / static_cast<double>(own.size());
      mean_y += y / static_cast<double>(own.size());
    }
    for (const auto& [x, y] : own) points.emplace_back(x - mean_x, y - mean_y);
  }
  return related(points, scenes.size());
}

ChartPanel scatter(const StudyResults& study, const std::string& title, const std::string& axis, const char* column) {
  ChartPanel panel{.title = title,
                   .kind = ChartKind::kPoints,
                   .x = {"overlap of siblings, levels 0 to 4, culled"},
                   .y = {axis, true}};
  std::vector<std::string> recipes;
  for (const ResultRow& row : study.rows) {
    const double x = row.number(kOverlapColumn), y = row.number(column);
    if (std::isnan(x) || !(y > 0)) continue;
    panel.measured.push_back({.series = row.recipe, .x = x, .y = y, .label = row.scene + ", " + group_label(row)});
  }
  panel.series = coloured(recipe_names(study.rows));
  return panel;
}

/// Marks of the authors' raw results; what they printed is told with each.
void add_published(std::string_view series, const PaperValues& raw, const PaperValues& printed, ChartPanel& panel) {
  std::vector<ChartPoint> points = published_points(series, raw, "");
  for (size_t i = 0; i < points.size(); ++i)
    points[i].label = fmt::format("authors' raw results; printed: {:.3f}", printed[i]);
  panel.published.insert(panel.published.end(), points.begin(), points.end());
}

/// In how many groups siblings overlap less under kFull than under the baseline, and where by most.
struct Lessened {
  size_t groups = 0, less = 0;
  std::string most;
};

Lessened lessened(const StudyResults& study, std::span<const std::string> groups, const RowValue& overlap) {
  Lessened result;
  double least = kNotMeasured;
  for (const std::string& group : groups) {
    const auto here = [&](std::string_view recipe) {
      return mean_of(
          filtered(study.rows, [&](const ResultRow& r) { return r.recipe == recipe && group_label(r) == group; }),
          overlap);
    };
    const double difference = here(kFull) - here(kBaseline);
    if (std::isnan(difference)) continue;
    ++result.groups;
    result.less += difference < 0;
    if (!(difference >= least)) {
      least = difference;
      result.most = group;
    }
  }
  return result;
}

}  // namespace

Chart overlap_cost_figure(const StudyResults& study) {
  Chart chart{.label = "Figure 20", .title = "Cost against overlap of siblings"};
  chart.verdict = Verdict::kMissing;
  const std::vector<ResultRow> full = rows_of_recipe(study.rows, kFull);
  const auto points = pairs_of(full, kOverlapColumn, "real_cost");
  const Related all = related(points, 1), within = related_within_scenes(full);
  const double real = all.correlation;
  const double pruned = correlation(pairs_of(full, kOverlapColumn, "pruned_cost"));
  if (std::isnan(real)) return chart;
  if (!std::isnan(pruned))
    chart.panels.push_back(
        scatter(study, "What users pay: pruned cost against overlap", "pruned cost per ray", "pruned_cost"));
  chart.panels.push_back(scatter(study, "As in the paper: full-traversal cost against overlap",
                                 "real cost per ray, full traversal", "real_cost"));
  const bool both = all.significant && within.significant;
  chart.verdict = both ? Verdict::kConfirms : real > 0 ? Verdict::kPartly : Verdict::kContradicts;
  chart.finding = fmt::format(
      "Over {} tests of {} the full-traversal cost has a correlation of {:.2f} with the overlap of siblings, where the "
      "published tests have {:.2f}; the pruned cost, which users pay, has {}; within a scene it is {:.2f}{}.",
      points.size(), kFull, real, kOverlapCorrelation,
      std::isnan(pruned) ? "not been measured" : fmt::format("{:.2f}", pruned), within.correlation,
      within.significant ? "" : ", which may be chance");
  chart.finding += scenes_sentence(full);
  chart.notes.emplace_back(
      "Confirmed where the correlation is significant (95 %) over all tests and, with each scene's means of overlap "
      "and "
      "of the logarithm of cost removed, within scenes: that scenes differ in both proves nothing.");
  chart.notes.emplace_back("Of the paper's own points only the picture is published.");
  if (const std::string note = scenes_note(full); !note.empty()) chart.notes.push_back(note);
  return chart;
}

Chart overlap_figure(const StudyResults& study) {
  Chart chart{.label = "Figure 22", .title = "Overlap of siblings in the top levels"};
  chart.verdict = Verdict::kMissing;
  std::vector<std::string> recipes{std::string(kFull), std::string(kBaseline)};
  for (const std::string& own : own_recipes(study))
    if (recipes.size() < 6) recipes.push_back(own);
  const RowValue overlap = column_value(kOverlapColumn);
  const double full = mean_of(rows_of_recipe(study.rows, kFull), overlap),
               standard = mean_of(rows_of_recipe(study.rows, kBaseline), overlap);
  if (std::isnan(full) || std::isnan(standard)) return chart;

  chart.panels = user_bars(study.rows, recipes);
  ChartPanel panel = group_bars(study.rows, recipes, "As in the paper: overlap, levels 0 to 4, culled",
                                "mean common area per smaller sibling's area", overlap);
  add_published(kFull, kOverlapOfFull, kPrintedOverlapOfFull, panel);
  add_published(kBaseline, kOverlapOfStandard, kPrintedOverlapOfStandard, panel);
  const Lessened than_standard = lessened(study, panel.groups, overlap);
  chart.panels.push_back(std::move(panel));
  // Two statements: less overlap on average, and least of all where rays are parallel to an axis.
  const bool on_average = full < standard, parallel = than_standard.most.ends_with("parallel");
  chart.verdict = verdict_of(size_t{on_average} + size_t{parallel}, 2);
  const std::string users = user_sentence(study, std::string(kFull), std::string(kBaseline));
  chart.finding = fmt::format(
      "Siblings overlap by {} in trees of {} and by {} in those of {} (paper: 59 % and 66 %), less in {} of {} groups "
      "and "
      "most of all for {}{}.",
      percent(full), kFull, percent(standard), kBaseline, than_standard.less, than_standard.groups, than_standard.most,
      users.empty() ? "" : "; " + users);
  chart.finding += scenes_sentence(study.rows);
  chart.notes.emplace_back(
      "Published marks are means of the authors' raw results; the printed figure differs from them by up to 10 % and "
      "is "
      "given with each mark.");
  if (const std::string note = scenes_note(study.rows); !note.empty()) chart.notes.push_back(note);
  return chart;
}

}  // namespace raygrain
