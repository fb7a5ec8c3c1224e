#include "raygrain/study_report.h"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include "raygrain/error.h"

#include "base/nearest_name.h"
#include "report/charts.h"

namespace raygrain {

namespace {

struct KnownStudy {
  std::string_view name, title, text;
};
/// In the order of the report.
constexpr std::array<KnownStudy, 8> kKnownStudies{{
    {"published", "The published evaluation",
     "The paper's tests with the rules of the authors' own program, quirks included: costs are to match the published "
     "ones."},
    {"paper", "The paper's evaluation, sound",
     "The same tests as the paper describes them: the best split is kept, one measure judges it, membership is exact."},
    {"corrected", "Corrected and extended",
     "Equal thresholds, all axes, matched rays, other builders and measures: what really pays."},
    {"parameters", "Parameters", "The three thresholds of table 2 and a finer grid, bins and levels."},
    {"areas", "Many areas", "Lists and octrees over 1 to 256 influence areas."},
    {"memory", "Memory", "Section 9.6 of the paper, measured."},
    {"scaling", "Scaling", "From a thousand to millions of triangles."},
    {"stress", "Stress", "Several areas at once, rays that no area knows, hit ratios at which an area pays."},
}};

const KnownStudy* known_study(std::string_view name) {
  const auto found =
      std::find_if(kKnownStudies.begin(), kKnownStudies.end(), [&](const KnownStudy& s) { return s.name == name; });
  return found == kKnownStudies.end() ? nullptr : &*found;
}

std::ptrdiff_t rank(std::string_view name) {
  const KnownStudy* known = known_study(name);
  return known ? known - kKnownStudies.data() : static_cast<std::ptrdiff_t>(kKnownStudies.size());
}

/// Names that no row has would leave nothing to show, or something else than was asked for.
void check_known(std::string_view name, const std::vector<StudyResults>& studies, const char* what,
                 std::string ResultRow::*field) {
  std::vector<std::string> names;
  for (const StudyResults& study : studies)
    for (const std::string& known : distinct(study.rows, [&](const ResultRow& row) { return row.*field; }))
      names.push_back(known);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  throw Error(ErrorCode::kUsage, std::string(name), std::string("is no ") + what + " of these results",
              suggestion(name, std::vector<std::string_view>(names.begin(), names.end())));
}

/// Studies in the order of the report, with ids that differ.
std::vector<StudyResults> make_studies(std::span<const ResultTable> tables, const StudyReportOptions& options) {
  std::vector<StudyResults> studies;
  for (const ResultTable& table : tables)
    studies.push_back({table.study, id_of(table.study), study_rows(table), options.baseline});
  if (!options.baseline.empty()) check_known(options.baseline, studies, "recipe", &ResultRow::recipe);
  for (const std::string& scene : options.scenes) check_known(scene, studies, "scene", &ResultRow::scene);
  const auto is_left_out = [&](const ResultRow& row) {
    return std::find(options.scenes.begin(), options.scenes.end(), row.scene) == options.scenes.end();
  };
  if (!options.scenes.empty())
    for (StudyResults& study : studies) std::erase_if(study.rows, is_left_out);
  std::erase_if(studies, [](const StudyResults& study) { return study.rows.empty(); });
  std::stable_sort(studies.begin(), studies.end(),
                   [](const StudyResults& a, const StudyResults& b) { return rank(a.name) < rank(b.name); });
  std::set<std::string> used;
  for (StudyResults& study : studies)
    for (const std::string id = study.id; !used.insert(study.id).second;)
      study.id = id + "-" + std::to_string(used.size());
  return studies;
}

void append(std::vector<Chart>& charts, std::vector<Chart> more) {
  std::move(more.begin(), more.end(), std::back_inserter(charts));
}

std::vector<Chart> paper_charts(const StudyResults& study) {
  std::vector<Chart> charts{prediction_figure(study)};
  append(charts, cost_figures(study));
  charts.push_back(split_time_figure(study));
  charts.push_back(overlap_cost_figure(study));
  charts.push_back(overlap_figure(study));
  return charts;
}

std::vector<Chart> charts_of(const StudyResults& study) {
  std::vector<Chart> charts;
  for (const auto make : {area_charts, memory_charts, stress_charts}) append(charts, make(study));
  if (!charts.empty()) return charts;  // rows of these studies are no trees

  if (study.name != "corrected" && has_paper_tests(study))
    append(charts, paper_charts({study.name, study.id, main_rays(study.rows)}));
  const bool all_tuning = std::all_of(study.rows.begin(), study.rows.end(), is_tuning_row);
  Chart tuning = tuning_table({study.name, study.id, main_rays(study.rows)});
  const bool is_tuned = tuning.verdict != Verdict::kMissing;
  if (is_tuned) {
    charts.push_back(std::move(tuning));
    append(charts, parameter_charts(study));
  }
  if (is_tuned && all_tuning) return charts;  // settings of one recipe
  append(charts, scaling_charts(study));
  append(charts, recipe_charts(study));
  return charts;
}

ChartSection section_of(const StudyResults& study) {
  const KnownStudy* known = known_study(study.name);
  ChartSection section{study.id, known ? std::string(known->title) : study.name, known ? std::string(known->text) : "",
                       charts_of(study)};
  std::erase_if(section.charts, [](const Chart& chart) { return chart.panels.empty() && chart.table.rows.empty(); });
  for (Chart& chart : section.charts)
    chart.id = study.id + "-" + id_of(chart.label.empty() ? chart.title : chart.label);
  return section;
}

/// Values of a column over all rows, each once.
std::string values_of(const StudyResults& study, std::string_view column) {
  std::string text;
  for (const std::string& value :
       distinct(study.rows, [&](const ResultRow& row) { return std::string(row.text(column)); }))
    if (!value.empty()) text += (text.empty() ? "" : ", ") + value;
  return text;
}

void add_facts(StudyReport& report, const StudyResults& study) {
  std::string text = counted(study.rows.size(), "row");
  for (const char* column : {"scene", "commit", "compiler", "cpu", "isa", "threads", "seed", "rays"})
    if (const std::string values = values_of(study, column); !values.empty())
      text += fmt::format("; {}: {}", column, values);
  report.facts.emplace_back(study.name, text);
}

}  // namespace

StudyReport make_study_report(std::span<const ResultTable> tables, const StudyReportOptions& options) {
  if (tables.empty()) throw Error(ErrorCode::kUsage, "report", "needs a results file", "Run raygrain study first");
  StudyReport report;
  report.title = "raygrain: what trees for known rays cost";
  for (const StudyResults& study : make_studies(tables, options)) {
    add_facts(report, study);
    report.sections.push_back(section_of(study));
  }
  std::vector<Chart> tables_of_paper{parameter_table()};
  const auto has_tuning = [](const ChartSection& section) {
    return std::any_of(section.charts.begin(), section.charts.end(),
                       [](const Chart& c) { return c.label == "Table 2"; });
  };
  if (std::none_of(report.sections.begin(), report.sections.end(), has_tuning)) {
    tables_of_paper.push_back(tuning_table({}));
    tables_of_paper.back().id = "table-2";
  }
  std::vector<Chart>& first = report.sections.front().charts;
  first.insert(first.begin(), tables_of_paper.begin(), tables_of_paper.end());
  if (Chart missing = missing_charts(report.sections); !missing.table.rows.empty())
    report.sections.push_back({"not-in-this-report", "Not in this report", "", {std::move(missing)}});
  return report;
}

}  // namespace raygrain
