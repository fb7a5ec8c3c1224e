// A heuristic of one's own in the paper's charts: some of its tests are run with it, and it appears by itself.
#include <algorithm>
#include <fstream>
#include <iostream>

#include <raygrain/raygrain.h>

int main() {
  raygrain::StudySources sources;
  sources.only = {"Random100"};
  raygrain::StudyGrid grid = raygrain::preset_grid("paper", sources);
  const auto edges = [](const raygrain::Bounds& box) {
    const raygrain::Vec3 e = extent(box);
    return e.x + e.y + e.z;
  };
  grid.registry.measures.push_back(
      {.name = "EDGES",
       .description = "length of the edges of a box",
       .make = [edges](const raygrain::HeuristicInput&) { return raygrain::RayMeasure(edges); }});
  grid.recipes.push_back({"EDGES+ALL", "", parse_recipe("EDGES+ALL", grid.registry)});
  run_study(make_study(grid), {.folder = "own-heuristic"});

  const raygrain::ResultTable results = raygrain::load_results("own-heuristic/results.csv");
  const raygrain::StudyReport report = raygrain::make_study_report({&results, 1});
  std::ofstream("own-heuristic/report.html") << static_page(report, "");

  size_t panels = 0, with_mine = 0;
  const auto is_mine = [](const raygrain::ChartPoint& p) { return p.series == "EDGES+ALL" || p.group == "EDGES+ALL"; };
  for (const raygrain::ChartSection& section : report.sections)
    for (const raygrain::Chart& chart : section.charts)
      for (const raygrain::ChartPanel& panel : chart.panels) {
        ++panels;
        with_mine += std::any_of(panel.measured.begin(), panel.measured.end(), is_mine) ? 1 : 0;
      }
  std::cout << "EDGES+ALL is in " << with_mine << " of " << panels << " charts of own-heuristic/report.html\n";
  return with_mine > 15 ? 0 : 1;
}
