// Figure 19 of the paper: the time spent on choosing split orientations.
#include <cmath>

#include <fmt/format.h>

#include "report/charts.h"
#include "report/published.h"

namespace raygrain {

namespace {

constexpr std::string_view kFacing = "SAH+SPFH";
constexpr double kSameTime = 0.5;  // "the same" up to this share: single times are noisy

RowValue milliseconds(const char* column) {
  return [column](const ResultRow& row) { return row.number(column) * 1e3; };
}

void append(std::vector<ChartPoint>& points, std::vector<ChartPoint> more) {
  points.insert(points.end(), more.begin(), more.end());
}

/// Only what the paper printed: files without times still show it.
ChartPanel published_alone() {
  ChartPanel panel{.title = "As in the paper: time to choose orientations", .y = {"total ms per build"}};
  for (const PaperGroup& group : kPaperGroups) panel.groups.emplace_back(group.label);
  panel.series = coloured({std::string(kFacing), std::string(kBaseline)});
  return panel;
}

std::vector<std::string> compared_recipes(const StudyResults& study) {
  std::vector<std::string> recipes{std::string(kFacing), std::string(kBaseline)};
  for (const std::string& own : own_recipes(study))
    if (recipes.size() < 6) recipes.push_back(own);
  return recipes;
}

/// How many orientations each tries, where that was counted.
void add_tried(const StudyResults& study, const std::vector<std::string>& recipes, Chart& chart) {
  const RowValue tried = column_value("orientations_per_node");
  const double facing = mean_of(rows_of_recipe(study.rows, kFacing), tried),
               longest = mean_of(rows_of_recipe(study.rows, kBaseline), tried);
  if (std::isnan(facing) || std::isnan(longest)) return;
  chart.panels.push_back(
      group_bars(study.rows, recipes, "Orientations tried per inner node", "mean orientations per inner node", tried));
  chart.notes.push_back(
      fmt::format("Orientations tried per inner node: SPFH {}, LSPH {}; the paper gives {} and {} (its LSPH used "
                  "another threshold).",
                  short_number(facing), short_number(longest), kOrientationsOfSpfh, kOrientationsOfLsph));
}

/// The verdict, where there are times of both.
void judge(const StudyResults& study, bool timed, Chart& chart) {
  const PairedRatio ratio = paired_ratio(study.rows, kFacing, kBaseline, milliseconds("orientation_seconds"));
  if (!timed || ratio.count == 0) {
    chart.finding =
        fmt::format("These files hold no {}, so the paper's statement that SPFH takes as long as LSPH is not judged.",
                    timed ? fmt::format("times of tests that both {} and {} have", kFacing, kBaseline)
                          : "times of choosing orientations");
    return;
  }
  chart.verdict = std::abs(std::log(ratio.mean)) < std::log1p(kSameTime) ? Verdict::kConfirms : Verdict::kContradicts;
  chart.finding = fmt::format(
      "Choosing orientations with SPFH takes {} times as long as with LSPH (geometric mean of {}), where the "
      "paper "
      "found them the same; the whole build takes {} times as long.",
      short_number(ratio.mean), counted(ratio.count, "build"),
      short_number(paired_ratio(study.rows, kFacing, kBaseline, milliseconds("build_seconds")).mean));
  chart.notes.emplace_back("Times of other machines cannot be compared; the paper compares the two heuristics only.");
  chart.notes.emplace_back("Within a factor of 1.5 times count as the same: single ones are noisy.");
}

}  // namespace

Chart split_time_figure(const StudyResults& study) {
  Chart chart{.label = "Figure 19", .title = "Time to choose split orientations: SPFH against LSPH"};
  chart.verdict = Verdict::kMissing;
  const std::vector<std::string> recipes = compared_recipes(study);
  const RowValue build = milliseconds("build_seconds"), choosing = milliseconds("orientation_seconds");
  if (any_measured(study.rows, build))
    chart.panels.push_back(
        group_bars(study.rows, recipes, "What users pay: time of the whole build", "mean ms per build", build));
  const bool timed = any_measured(study.rows, choosing);
  ChartPanel times = timed ? group_bars(study.rows, recipes, "As in the paper: time to choose orientations",
                                        "mean of total ms per build", choosing)
                           : published_alone();
  append(times.published, published_points(kFacing, kSplitTimeOfSpfh, "printed, total ms per build, their machine"));
  append(times.published, published_points(kBaseline, kSplitTimeOfLsph, "printed, total ms per build, their machine"));
  chart.panels.push_back(std::move(times));
  add_tried(study, recipes, chart);
  if (const std::string note = scenes_note(study.rows); !note.empty()) chart.notes.push_back(note);
  judge(study, timed, chart);
  return chart;
}

}  // namespace raygrain
