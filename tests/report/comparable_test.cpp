// Own recipes beside a tuned one, and means over different tests, which say nothing of each other.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/study_report.h"

#include "paper_results.h"

namespace raygrain::test {
namespace {

struct Thresholds {
  const char* quality = "0.4";
  const char* bins = "40";
  const char* levels = "100";
};

/// Rows as a study of trees writes them, whose costs are all one number.
class Table {
 public:
  Table() {
    table_ = {
        "mine",
        "",
        {"scene", "kind", "variant", "recipe", "setting", "real_cost", "pruned_cost", "build_seconds",
         "split_plane_quality_threshold", "acceptable_ratio", "excellent_ratio", "bins", "max_non_fallback_levels"},
        {}};
  }

  void add(const char* scene, const char* recipe, const char* setting, double cost, const Thresholds& t = {}) {
    const std::string text = std::to_string(cost);
    table_.rows.push_back(
        {scene, "plane", "parallel", recipe, setting, text, text, text, t.quality, "1.3", "0.9", t.bins, t.levels});
  }

  StudyReport report(const StudyReportOptions& options = {}) const { return make_study_report({&table_, 1}, options); }

 private:
  ResultTable table_;
};

bool has_chart(const StudyReport& report, const std::string& title) {
  for (const ChartSection& section : report.sections)
    for (const Chart& chart : section.charts)
      if (chart.title == title) return true;
  return false;
}

bool shows(const ChartPanel& panel, const std::string& group) {
  return std::find(panel.groups.begin(), panel.groups.end(), group) != panel.groups.end();
}

constexpr const char* kThresholds = "The three thresholds, each with each";
constexpr const char* kBins = "Slices per axis (bins)";

/// The example of docs/formats.md, with PAH+SPFH as it is, so that there is something to compare quality 0.1 with.
TEST(Comparable, OwnRecipesStayWhereTable2CanBeJudged) {
  Table table;
  for (const char* scene : {"Random1000", "City", "house"}) {
    table.add(scene, "SAH+LSPH", "", 100);
    table.add(scene, "MINE+ALL@binned", "", 70);
    table.add(scene, "PAH+SPFH", "", 95);
    table.add(scene, "PAH+SPFH", "quality 0.1", 90, {"0.1"});
    table.add(scene, "PAH+ALL, improved", "", 80);
  }
  const StudyReport report = table.report();
  EXPECT_EQ(chart_of(report, "Table 2").verdict, Verdict::kConfirms);
  const Chart all = chart_of(report, "All recipes against SAH+LSPH");
  ASSERT_EQ(all.panels.size(), 1u);
  EXPECT_EQ(all.panels[0].groups, (std::vector<std::string>{"MINE+ALL@binned", "PAH+ALL, improved",
                                                            "PAH+SPFH quality 0.1", "PAH+SPFH", "SAH+LSPH"}));
  const Chart thresholds = chart_of(report, kThresholds);
  ASSERT_FALSE(thresholds.panels.empty());
  EXPECT_EQ(thresholds.panels[0].measured.size(), 2u) << "others are no settings of PAH+SPFH";
  EXPECT_NE(thresholds.finding.find("quality 0.1"), std::string::npos) << thresholds.finding;
  EXPECT_FALSE(has_chart(report, kBins)) << "one number of bins is no line";
}

/// As preset_grid("parameters") with a recipe more.
TEST(Comparable, OwnRecipesStandBesideTheParameters) {
  Table table;
  for (const char* scene : {"Random100", "Random1000"}) {
    table.add(scene, "MINE+ALL", "", 50, {"0.4", "7"});
    table.add(scene, "PAH+SPFH", "quality 0.4", 100);
    table.add(scene, "PAH+SPFH", "quality 0.1", 90, {"0.1"});
    for (const char* bins : {"8", "16"})
      table.add(scene, "PAH+SPFH", (std::string("bins ") + bins).c_str(), 120, {"0.4", bins});
  }
  const StudyReport report = table.report();
  const Chart all = chart_of(report, "All recipes against PAH+SPFH quality 0.4");
  ASSERT_EQ(all.panels.size(), 1u);
  EXPECT_EQ(all.panels[0].groups.front(), "MINE+ALL");
  EXPECT_NEAR(value_of(all.panels[0].measured, "pruned cost", "MINE+ALL"), 0.5, 1e-6);
  const Chart bins = chart_of(report, kBins);
  EXPECT_NE(bins.finding.find("lowest with 40"), std::string::npos) << bins.finding;
  EXPECT_EQ(std::count_if(bins.panels.at(0).measured.begin(), bins.panels[0].measured.end(),
                          [](const ChartPoint& p) { return p.series == "pruned cost"; }),
            3);
}

TEST(Comparable, SettingsOfOneRecipeAreNoRanking) {
  Table table;
  table.add("Wood", "PAH+SPFH", "", 100);
  table.add("Wood", "PAH+SPFH", "quality 0.1", 90, {"0.1"});
  EXPECT_FALSE(has_chart(table.report(), "All recipes against PAH+SPFH"));
}

/// Over the tests that both have, quality 0.1 is better; by each one's own tests 0.8 would be.
TEST(Comparable, ParametersAreJudgedOverTheSameTests) {
  Table table;
  for (const char* scene : {"Wood", "Suzanne", "Crowd", "Sponza"}) {
    const bool is_large = scene[0] == 'C' || std::string(scene) == "Sponza";
    table.add(scene, "PAH+SPFH", "", 100);
    table.add(scene, "PAH+SPFH", "quality 0.8", is_large ? 50 : 90, {"0.8"});
    if (!is_large) {
      table.add(scene, "PAH+SPFH", "quality 0.1", 80, {"0.1"});
      table.add(scene, "PAH+SPFH", "bins 8", 99, {"0.4", "8"});
    }
    table.add(scene, "PAH+SPFH", "bins 16", is_large ? 10 : 110, {"0.4", "16"});
  }
  const StudyReport report = table.report();
  const std::string thresholds = chart_of(report, kThresholds).finding, bins = chart_of(report, kBins).finding;
  EXPECT_NE(thresholds.find("quality 0.1"), std::string::npos) << thresholds;
  EXPECT_NE(thresholds.find("over 2 tests"), std::string::npos) << thresholds;
  EXPECT_NE(bins.find("lowest with 8: 0.990 times"), std::string::npos) << bins;
}

TEST(Comparable, RecipesAreRankedOverTheSameTests) {
  Table table;
  for (const char* scene : {"a", "b", "c", "d"}) {
    const bool is_half = scene[0] > 'b';
    table.add(scene, "SAH+LSPH", "", 100);
    table.add(scene, "WHOLE", "", is_half ? 20 : 90);
    if (!is_half) table.add(scene, "HALF", "", 80);
  }
  table.add("d", "QUARTER", "", 1);
  const StudyReport report = table.report();
  const Chart all = chart_of(report, "All recipes against SAH+LSPH");
  ASSERT_EQ(all.panels.size(), 2u);
  EXPECT_EQ(all.panels[0].groups, (std::vector<std::string>{"HALF", "WHOLE", "SAH+LSPH"}));
  EXPECT_NEAR(value_of(all.panels[0].measured, "pruned cost", "WHOLE"), 0.9, 1e-6);
  EXPECT_TRUE(all.finding.starts_with("HALF is best: 0.800 times")) << all.finding;
  EXPECT_TRUE(shows(all.panels[1], "QUARTER"));
  ASSERT_EQ(all.notes.size(), 1u);
  EXPECT_NE(all.notes[0].find("QUARTER"), std::string::npos) << all.notes[0];
  const std::string building = chart_of(report, "What building costs").finding;
  EXPECT_TRUE(building.starts_with("Trees of HALF are built fastest (0.800 times")) << building;
}

/// What docs/study.md quotes: a ratio, and in how many tests it is a gain, over scenes and against a recipe of choice.
TEST(Comparable, BaselineAndScenesAreOfChoice) {
  Table table;
  for (const char* scene : {"Wood", "Suzanne", "Sponza"}) {
    table.add(scene, "SAH+LSPH", "", 100);
    table.add(scene, "SAH+ALL", "", 50);
    table.add(scene, "PAH+ALL", "", scene[0] == 'W' ? 80 : scene[1] == 'u' ? 20 : 1);
  }
  const StudyReport report = table.report({.baseline = "SAH+ALL", .scenes = {"Wood", "Suzanne"}});
  const Chart chart = chart_of(report, "All recipes against SAH+ALL");
  EXPECT_NEAR(value_of(chart.panels.at(0).measured, "pruned cost", "PAH+ALL"), 0.8, 1e-6);
  ASSERT_EQ(chart.table.rows.size(), 3u);
  EXPECT_EQ(chart.table.rows[0][0], "PAH+ALL");
  EXPECT_EQ(chart.table.rows[0][1], "in 1 of 2 tests");
  const auto none = [](const Chart&, size_t) { return std::string{}; };
  EXPECT_NE(report_markdown(report, none).find("| PAH+ALL | in 1 of 2 tests |"), std::string::npos);
  EXPECT_THROW(table.report({.baseline = "SAH+ALLL"}), Error);
  EXPECT_THROW(table.report({.scenes = {"Crowd"}}), Error);
}

/// Trees in ray space take one ray at a time; times of arrays are not held against theirs.
TEST(Comparable, TimesAreOfRaysSearchedTheSameWay) {
  ResultTable table{"mine", "", {"scene", "recipe", "pruned_cost", "ray_seconds", "single_ray_seconds"}, {}};
  table.rows = {{"a", "SAH+LSPH", "4", "1e-7", "4e-7"}, {"a", "IN FRAME", "2", "", "2e-7"}};
  const Chart chart = chart_of(make_study_report({&table, 1}), "All recipes against SAH+LSPH");
  EXPECT_TRUE(std::isnan(value_of(chart.panels.at(0).measured, "time per ray", "IN FRAME")));
  EXPECT_NEAR(value_of(chart.panels.at(0).measured, "time per ray, one at a time", "IN FRAME"), 0.5, 1e-9);
  ASSERT_EQ(chart.notes.size(), 1u);
  EXPECT_NE(chart.notes[0].find("one ray at a time"), std::string::npos);
}

TEST(Comparable, TheFallbackIsJudgedOverTheSameTests) {
  ResultTable table{
      "mine", "", {"scene", "recipe", "pruned_cost", "pruned_cost_with_fallback", "global_pruned_cost"}, {}};
  for (const char* scene : {"a", "b", "c", "d"}) {
    const bool is_half = scene[0] > 'b';
    table.rows.push_back({scene, "SAH+LSPH", "1", "3", "2"});
    table.rows.push_back({scene, "WHOLE", "1", is_half ? "1" : "3", "2"});
    if (!is_half) table.rows.push_back({scene, "HALF", "1", scene[0] == 'a' ? "1" : "3", "2"});
  }
  const std::string finding = chart_of(make_study_report({&table, 1}),
                                       "Local trees with fallback against the global "
                                       "tree alone")
                                  .finding;
  EXPECT_NE(finding.find("in 1 of 2 tests with HALF"), std::string::npos) << finding;
}

}  // namespace
}  // namespace raygrain::test
