// What a report says is missing, its charts of studies of any kind, and its forms: page, pictures, Markdown.
#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "raygrain/error.h"
#include "raygrain/study_report.h"

#include "paper_results.h"

namespace raygrain::test {
namespace {

StudyReport report_of(const ResultTable& table) {
  return make_study_report({&table, 1});
}

TEST(StudyReport, SaysWhichTimesOfChoosingAreMissing) {
  ResultTable table = paper_results();
  std::erase_if(table.rows, [](const auto& row) { return row[3] == "SAH+SPFH"; });
  const std::string finding = chart_of(report_of(table), "Figure 19").finding;
  EXPECT_NE(finding.find("hold no times of tests that both SAH+SPFH and SAH+LSPH have"), std::string::npos) << finding;
}

TEST(StudyReport, ShowsWhatTable2SaidWhereItWasNotMeasured) {
  const StudyReport report = report_of(paper_results());
  const Chart chart = chart_of(report, "Table 2");
  EXPECT_EQ(chart.verdict, Verdict::kMissing);
  EXPECT_NE(chart.finding.find("raygrain study parameters"), std::string::npos) << chart.finding;
  ASSERT_EQ(chart.table.rows.size(), 5u);
  EXPECT_EQ(chart.table.rows[0],
            (std::vector<std::string>{"0.4", "1.3", "0.9", "-", "-", "110.5", "-", "1.8", "-", "0.34"}));
  EXPECT_EQ(report.sections.front().charts.at(1).label, "Table 2");
  EXPECT_NE(static_page(report, "").find("110.5"), std::string::npos);
}

/// Nothing vanishes without a word.
TEST(StudyReport, SaysWhatIsMissingAndHowToMakeIt) {
  const auto missing = [](const StudyReport& report) {
    std::vector<std::string> names;
    for (const ChartSection& section : report.sections)
      if (section.id == "not-in-this-report")
        for (const auto& row : section.charts.at(0).table.rows) {
          names.push_back(row.at(0));
          EXPECT_TRUE(row.at(2).starts_with("raygrain study ")) << row.at(2);
        }
    return names;
  };
  EXPECT_EQ(missing(report_of(paper_results())),
            (std::vector<std::string>{"Table 2", "published", "corrected", "parameters", "areas", "memory", "scaling",
                                      "stress"}));
  ResultTable table = paper_results();
  for (auto& row : table.rows) row[6] = row[7] = row[8] = "";  // no estimates, no overlap
  const std::vector<std::string> less = missing(report_of(table));
  for (const char* label : {"Figure 14", "Figure 20", "Figure 22"})
    EXPECT_NE(std::find(less.begin(), less.end(), label), less.end()) << label;
  std::vector<ResultTable> all;
  for (const char* name : {"published", "paper", "corrected", "parameters", "areas", "memory", "scaling", "stress"}) {
    all.push_back(paper_results());
    all.back().study = name;
  }
  EXPECT_EQ(missing(make_study_report(all)), std::vector<std::string>{"Table 2"});
}

TEST(StudyReport, ChartsOfAnyStudyHaveIdsThatDiffer) {
  const ResultTable tables[] = {paper_results(), paper_results({"MINE+ALL"})};
  const StudyReport report = make_study_report(tables);
  std::vector<std::string> ids;
  for (const ChartSection& section : report.sections)
    for (const Chart& chart : section.charts) ids.push_back(chart.id);
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(std::adjacent_find(ids.begin(), ids.end()), ids.end());
  EXPECT_THROW(make_study_report({}), Error);
}

TEST(StudyReport, Table2IsFoundByItsThresholds) {
  ResultTable table{"parameters",
                    "",
                    {"scene", "kind", "variant", "recipe", "setting", "real_cost", "pruned_cost",
                     "split_plane_quality_threshold", "acceptable_ratio", "excellent_ratio", "bins"},
                    {}};
  const auto add = [&](const char* quality, const char* acceptable, const char* excellent, const char* cost,
                       const char* bins) {
    const std::string setting = std::string(quality) + acceptable + excellent + bins;
    table.rows.push_back(
        {"Wood", "plane", "parallel", "PAH+SPFH", setting, cost, cost, quality, acceptable, excellent, bins});
  };
  add("0.4", "1.3", "0.9", "110", "40");
  add("0.4", "1.3", "0.9", "9999", "8");  // another parameter: not of the table
  add("0.1", "1.3", "0.9", "88", "40");
  add("0.8", "1.3", "0.9", "148", "40");
  add("0.4", "1.1", "0.7", "150", "40");  // the paper says 69.1
  add("0.4", "1.5", "1.1", "124", "40");
  const StudyReport report = report_of(table);
  const Chart chart = chart_of(report, "Table 2");
  EXPECT_EQ(chart.verdict, Verdict::kPartly) << chart.finding;
  EXPECT_NE(chart.finding.find("3 of 4"), std::string::npos) << chart.finding;
  EXPECT_EQ(chart.table.rows.at(0).at(4), "110");
  EXPECT_EQ(chart.table.rows.at(3).at(5), "69.1");
}

TEST(StudyReport, StudiesOfOtherThingsHaveTheirOwnCharts) {
  const ResultTable areas{
      "areas",
      "",
      {"scene", "variant", "recipe", "setting", "areas", "top_level", "top_level_query_seconds", "ray_seconds"},
      {{"City", "1 areas", "list", "", "1", "list", "1e-9", "1e-7"},
       {"City", "1 areas", "octree", "level 5", "1", "octree", "2e-9", "1e-7"},
       {"City", "64 areas", "list", "", "64", "list", "6e-8", "2e-7"},
       {"City", "64 areas", "octree", "level 5", "64", "octree", "3e-9", "1e-7"}}};
  const std::string found = chart_of(report_of(areas), "List and octrees over many areas, City").finding;
  EXPECT_NE(found.find("from 64 areas on"), std::string::npos) << found;

  const ResultTable memory{
      "memory",
      "",
      {"scene", "variant", "total_memory_bytes", "global_memory_bytes", "published_memory_bytes",
       "total_paper_memory_bytes"},
      {{"Wood", "parallel", "300", "100", "", ""}, {"section 9.6", "20 areas", "", "", "191220000", "150100000"}}};
  EXPECT_EQ(chart_of(report_of(memory), "Section 9.6").verdict, Verdict::kContradicts);

  const ResultTable stress{"stress",
                           "",
                           {"scene", "recipe", "foreign_share", "pruned_cost_with_fallback", "global_pruned_cost"},
                           {{"Wood", "PAH+ALL", "0", "10", "20"}, {"Wood", "PAH+ALL", "1", "20", "20"}}};
  const std::string gains =
      chart_of(report_of(stress), "Several areas at once, and rays that none of them knows").finding;
  EXPECT_NE(gains.find("0.500 (0 % foreign rays) to 1.00 (100 % foreign rays)"), std::string::npos) << gains;
}

TEST(StudyReport, JsonIsThereForEveryChart) {
  const auto json = nlohmann::json::parse(study_report_json(report_of(paper_results({"\xff</script>"}))));
  EXPECT_EQ(json["sections"][0]["charts"][0]["label"], "Table 1");
  EXPECT_TRUE(json["sections"][0]["charts"][3]["panels"][0]["reference"].is_null());
}

TEST(InteractivePage, IsFilledOnceAndSafely) {
  const StudyReport report = report_of(paper_results({"</script><b>"}));
  const std::string page = interactive_page(report, "<a>@RAYGRAIN_REPORT@</a>", "t.html");
  EXPECT_EQ(page.substr(0, 4), "<a>{");
  EXPECT_EQ(page.find("</script>"), std::string::npos);
  EXPECT_EQ(page.find('@'), std::string::npos);
  EXPECT_THROW(interactive_page(report, "<html></html>", "t.html"), Error);
  EXPECT_THROW(interactive_page(report, "@RAYGRAIN_REPORT@ @RAYGRAIN_REPORT@", "t.html"), Error);
}

TEST(StaticPage, IsWholeWithoutScripts) {
  const std::string page = static_page(report_of(paper_results({"<MINE> & \"others\""})), "note <1>");
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_NE(page.find("Figure 22"), std::string::npos);
  EXPECT_NE(page.find("&lt;MINE&gt; &amp; &quot;others&quot;"), std::string::npos);
  for (const char* bad : {"<MINE>", "<script", "http-equiv", "src=", "note <1>"})
    EXPECT_EQ(page.find(bad), std::string::npos) << bad;
}

TEST(Markdown, HasFindingsPicturesAndValues) {
  std::vector<std::string> asked;
  const std::string text = report_markdown(report_of(paper_results({"a|b"})), [&](const Chart& chart, size_t panel) {
    asked.push_back(chart.id + std::to_string(panel));
    return "pictures/" + asked.back() + ".png";
  });
  EXPECT_NE(text.find("### Figure 16. "), std::string::npos);
  EXPECT_NE(text.find("*confirms*: "), std::string::npos);
  EXPECT_NE(text.find("| plane parallel | 65.5 (65.5) | 88.9 (88.9) "), std::string::npos) << text;
  EXPECT_NE(text.find("a\\|b"), std::string::npos);
  EXPECT_GT(asked.size(), 20u);
  for (const std::string& name : asked) EXPECT_NE(text.find("(pictures/" + name + ".png)"), std::string::npos) << name;
}

TEST(ChartPictures, AreDrawnOnWhiteInTheirOwnColours) {
  for (const ChartKind kind :
       {ChartKind::kBars, ChartKind::kRanking, ChartKind::kDots, ChartKind::kPoints, ChartKind::kLines}) {
    ChartPanel panel{
        .title = "title", .kind = kind, .groups = {"one", "two"}, .series = {{"a", "#ff0000"}}, .reference = 3};
    panel.measured = {{.series = "a", .group = "one", .x = 1, .y = 5}, {.series = "a", .group = "two", .x = 2, .y = 2}};
    panel.published = {{.series = "a", .group = "one", .x = 1, .y = 4},
                       {.series = "foreign", .group = "one", .x = 1, .y = 4}};
    const Image image = chart_image(panel);
    ASSERT_EQ(image.rgb.size(), size_t{image.width} * image.height * 3);
    size_t red = 0, dark = 0;
    for (size_t i = 0; i < image.rgb.size(); i += 3) {
      red += image.rgb[i] == 255 && image.rgb[i + 1] == 0;
      dark += image.rgb[i] < 64 && image.rgb[i + 1] < 64;
    }
    EXPECT_GT(red, 100u) << static_cast<int>(kind);
    EXPECT_GT(dark, 100u) << static_cast<int>(kind);
    EXPECT_NE(chart_svg(panel).find("a, one"), std::string::npos) << "pointing at a mark tells its value";
  }
  const ChartPanel matrix{.kind = ChartKind::kMatrix,
                          .groups = {"g"},
                          .series = {{"a", "#ff0000"}},
                          .measured = {{.series = "a", .group = "g", .y = 0.25}},
                          .reference = 1};
  EXPECT_NE(chart_svg(matrix).find(">0.250</text>"), std::string::npos);
  EXPECT_GT(chart_image(ChartPanel{}).height, 100u) << "nothing to show is no crash";
  const ChartPanel huge{.y = {"", true},
                        .groups = {"g"},
                        .series = {{"a", "no colour"}},
                        .measured = {{.series = "a", .group = "g", .y = -1},
                                     {.series = "a", .group = "g", .y = INFINITY},
                                     {.series = "a", .group = "g", .y = 1e300}}};
  EXPECT_NE(chart_svg(huge).find("</svg>"), std::string::npos);
}

TEST(StudyReport, LinksPagesInAllItsForms) {
  StudyReport report = report_of(paper_results());
  report.links = {{"See <Sponza>", "views/sponza%20sun.html"}};
  EXPECT_NE(static_page(report, "").find("<a href=\"views/sponza%20sun.html\">See &lt;Sponza&gt;</a>"),
            std::string::npos);
  EXPECT_NE(
      report_markdown(report, [](const Chart&, size_t) { return std::string{}; }).find("](views/sponza%20sun.html)"),
      std::string::npos);
  const auto json = nlohmann::json::parse(study_report_json(report));
  EXPECT_EQ(json["links"][0]["address"], "views/sponza%20sun.html");
}

}  // namespace
}  // namespace raygrain::test
