// What a report does not show, and how to get it: nothing of the paper's evaluation vanishes without a word.
#include <algorithm>
#include <array>

#include "report/charts.h"

namespace raygrain {

namespace {

/// `mark`: a figure's or table's label, or the id of a study's section.
struct Part {
  std::string_view mark, title, study;
};
constexpr std::array<Part, 16> kParts{{
    {"Figure 14", "How well PAH and SAH predict the cost of a ray", "paper"},
    {"Figure 16", "PAH and SPFH against SAH and LSPH", "paper"},
    {"Figure 17", "PAH and LSPH against SAH and LSPH", "paper"},
    {"Figure 18", "SAH and SPFH against SAH and LSPH", "paper"},
    {"Figure 19", "Time to choose split orientations", "paper"},
    {"Figure 20", "Cost against overlap of siblings", "paper"},
    {"Figure 22", "Overlap of siblings in the top levels", "paper"},
    {"Table 2", "Three thresholds, measured", "parameters"},
    {"published", "The tests by the rules of the published runs", "published"},
    {"paper", "The tests as the paper describes them", "paper"},
    {"corrected", "Equal thresholds, all axes, other builders and measures", "corrected"},
    {"parameters", "A finer grid of thresholds, bins and levels", "parameters"},
    {"areas", "Lists and octrees over many areas", "areas"},
    {"memory", "Memory, section 9.6", "memory"},
    {"scaling", "Over the number of triangles", "scaling"},
    {"stress", "Several areas at once, foreign rays", "stress"},
}};

bool is_there(const Part& part, std::span<const ChartSection> sections) {
  return std::any_of(sections.begin(), sections.end(), [&](const ChartSection& section) {
    const auto shows = [&](const Chart& chart) {
      return chart.label == part.mark && (chart.verdict != Verdict::kMissing || !chart.panels.empty());
    };
    return section.id == part.mark || std::any_of(section.charts.begin(), section.charts.end(), shows);
  });
}

}  // namespace

Chart missing_charts(std::span<const ChartSection> sections) {
  Chart chart{.id = "missing-charts", .title = "What is missing, and the commands that make it"};
  chart.verdict = Verdict::kMissing;
  chart.table.columns = {"missing", "what it shows", "command"};
  for (const Part& part : kParts)
    if (!is_there(part, sections))
      chart.table.rows.push_back(
          {std::string(part.mark), std::string(part.title),
           "raygrain study " + std::string(part.study) + (part.study == "scaling" ? "" : " --scenes DIR")});
  chart.finding = "The files of this report hold nothing of these; give it the results of the commands, too.";
  return chart;
}

}  // namespace raygrain
