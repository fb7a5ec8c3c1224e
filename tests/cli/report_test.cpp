// raygrain report: what it writes, and that it writes nothing where something is wrong.
#include <filesystem>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace raygrain::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kResults =
    "scene,kind,variant,combo,real_cost_local,pruned_cost\n"
    "Wood,plane,parallel,SAH+LSPH,100,50\nWood,plane,parallel,PAH+SPFH,80,45\nWood,plane,parallel,MINE+ALL,60,20\n";

class ReportCommand : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write_file(path("paper.csv"), kResults);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Fails with this code and message, in one line, and leaves what was there.
  void expect_refusal(const std::vector<std::string>& arguments, int code, const std::string& message) {
    const std::vector<std::string> before = names_in(folder_);
    std::vector<std::string> all{"report"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const RunResult result = run_program(all);
    EXPECT_EQ(result.exit_code, code) << result.errors;
    EXPECT_TRUE(result.errors.starts_with("raygrain: error: ")) << result.errors;
    EXPECT_NE(result.errors.find(message), std::string::npos) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1);
    EXPECT_EQ(names_in(folder_), before) << message;
  }

  fs::path folder_ = fs::path(testing::TempDir()) /
                     (std::string("report_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(ReportCommand, WritesAPageWithoutScripts) {
  const RunResult result = run_program({"report", path("paper.csv"), "--out", path("report.html"), "--static"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  EXPECT_NE(result.output.find("Figure 16 [not comparable] With PAH+SPFH users pay 0.900 times the pruned cost"),
            std::string::npos)
      << result.output;
  const std::string page = read_file(path("report.html"));
  EXPECT_TRUE(page.starts_with("<!doctype html>"));
  EXPECT_TRUE(page.ends_with("</html>\n"));
  EXPECT_NE(page.find("MINE+ALL"), std::string::npos);
}

/// Of a study or of a comparison; where both are there, the study's.
TEST_F(ReportCommand, TakesFoldersThatHoldResults) {
  fs::create_directories(path("compared"));
  write_file(path("compared/compare.csv"), "name,area,real_cost,pruned_cost\nSAH+ALL,sun,3,2\nPAH+ALL,sun,2,1\n");
  const RunResult compared = run_program({"report", path("compared"), "--static", "--out", path("report.html")});
  EXPECT_EQ(compared.exit_code, 0) << compared.errors;
  EXPECT_NE(compared.output.find("PAH+ALL is best"), std::string::npos) << compared.output;
  write_file(path("compared/results.csv"), kResults);
  const RunResult study = run_program({"report", path("compared"), "--static", "--out", path("report.html")});
  EXPECT_NE(study.output.find("Figure 16"), std::string::npos) << study.output;
  fs::create_directories(path("nothing"));
  expect_refusal({path("nothing"), "--out", path("report.html")}, 1, "results.csv");
}

TEST_F(ReportCommand, FillsThePageThatItIsGiven) {
  write_file(path("page.html"), "<script>@RAYGRAIN_REPORT@</script>");
  const RunResult result =
      run_program({"report", path("paper.csv"), "--out", path("report.html"), "--template", path("page.html"), "-q"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const std::string page = read_file(path("report.html"));
  const auto json = nlohmann::json::parse(page.substr(8, page.size() - 8 - 9));
  EXPECT_EQ(json["sections"][0]["id"], "paper");
}

TEST_F(ReportCommand, WritesMarkdownWithPicturesThatAreThere) {
  const RunResult result = run_program({"report", path("paper.csv"), "--markdown", path("report.md")});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const std::string text = read_file(path("report.md"));
  size_t pictures = 0;
  for (size_t at = text.find("]("); at != std::string::npos; at = text.find("](", at + 1)) {
    const std::string link = text.substr(at + 2, text.find(')', at) - at - 2);
    EXPECT_TRUE(read_file(path(link)).starts_with("\x89PNG")) << link;
    ++pictures;
  }
  EXPECT_EQ(pictures, 4u) << "figure 16 and all recipes";
}

TEST_F(ReportCommand, TakesFoldersAndWritesJsonAlone) {
  fs::create_directories(folder_ / "corrected");
  write_file(path("corrected/results.csv"), kResults);
  const RunResult result = run_program({"report", path("corrected"), path("paper.csv"), "--json", "-"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["sections"][0]["id"], "paper") << "in the order of the report";
  EXPECT_EQ(json["sections"][1]["id"], "corrected");
}

TEST_F(ReportCommand, RefusesBadResultsAndWritesNothing) {
  constexpr int kData = 1, kUsage = 2;
  const std::string out = path("report.html");
  write_file(path("empty.csv"), "");
  write_file(path("foreign.csv"), "date,close\n2020-01-01,5\n");
  write_file(path("cut.csv"), "scene,combo,pruned_cost\nWood,a,1\nWood,");
  write_file(path("text.csv"), "combo,pruned_cost\na,cheap\n");
  fs::create_directories(folder_ / "no_results");
  expect_refusal({path("nothing.csv"), "--out", out}, kData, "nothing.csv");
  expect_refusal({path("no_results"), "--out", out}, kData, "results.csv");
  expect_refusal({path("empty.csv"), "--out", out}, kData, "the file is empty");
  expect_refusal({path("foreign.csv"), "--out", out}, kData, "foreign.csv:1: is no results file");
  expect_refusal({path("cut.csv"), "--out", out}, kData, "cut.csv:3: 2 cells");
  expect_refusal({path("text.csv"), "--out", out}, kData, "text.csv:2: \"cheap\" in column \"pruned_cost\"");
  expect_refusal({path("paper.csv"), path("text.csv"), "--out", out}, kData, "text.csv:2");
  expect_refusal({path("paper.csv"), "--out", out, "--only", "Wod"}, kUsage, "Wod: is no scene of these results");
  expect_refusal({path("paper.csv"), "--out", out, "--baseline", "MINE"}, kUsage,
                 "MINE: is no recipe of these results");
  expect_refusal({path("paper.csv"), "--out", path("no/report.html")}, kData, "its folder does not exist");
  expect_refusal({path("paper.csv"), "--out", folder_.string()}, kData, "is a folder");
  expect_refusal({path("paper.csv"), "--markdown", path("no/report.md")}, kData, "its folder does not exist");
  expect_refusal({path("paper.csv"), "--out", out, "--template", path("paper.csv")}, kData, "is no report page");
  expect_refusal({path("paper.csv"), "--out", out, "--template", path("nothing.html")}, kData, "nothing.html");
  expect_refusal({path("paper.csv"), "--out", out, "--views", path("nothing.html")}, kData, "there is no such page");
  expect_refusal({path("paper.csv"), "--out", out, "--views", path("paper.csv")}, kData, "no page of raygrain view");
  expect_refusal({path("paper.csv")}, kUsage, "nothing to write");
  expect_refusal({"--out", out}, kUsage, "RESULTS is required");
  expect_refusal({path("paper.csv"), "--out", "-"}, kUsage, "--out: needs a file");
}

TEST_F(ReportCommand, LinksPagesOfTheViewer) {
  write_file(path("viewer.html"), "<script>@RAYGRAIN_VIEW@</script><script>@RAYGRAIN_BLOBS@</script>");
  const RunResult view = run_program({"view", "procedural:random100", "--recipes", "SAH+ALL", "--template",
                                      path("viewer.html"), "--out", path("random view.html")});
  ASSERT_EQ(view.exit_code, 0) << view.errors;
  const RunResult report = run_program(
      {"report", path("paper.csv"), "--views", path("random view.html"), "--out", path("report.html"), "--static"});
  EXPECT_EQ(report.exit_code, 0) << report.errors;
  EXPECT_NE(read_file(path("report.html")).find("<a href=\"random%20view.html\">"), std::string::npos);
}

#ifdef RAYGRAIN_CUSTOM_STUDY
/// Labels or titles of the charts that hold a measured value of the recipe.
std::set<std::string> charts_with(const nlohmann::json& report, const std::string& recipe) {
  std::set<std::string> charts;
  for (const auto& section : report.at("sections"))
    for (const auto& chart : section.at("charts"))
      for (const auto& panel : chart.at("panels"))
        for (const auto& point : panel.value("measured", nlohmann::json::array()))
          if ((point.value("series", "") == recipe || point.value("group", "") == recipe) && point.at("y").is_number())
            charts.insert(chart.at("label") == "" ? chart.at("title") : chart.at("label"));
  return charts;
}

/// From an example that knows the public headers alone to the charts of a page.
TEST_F(ReportCommand, ChartsTheHeuristicsOfTheExample) {
  RunOptions example;
  example.folder = folder_.string();
  example.program = RAYGRAIN_CUSTOM_STUDY;
  const RunResult study = run_program({}, example);
  ASSERT_EQ(study.exit_code, 0) << study.errors;
  const RunResult result = run_program(
      {"report", path("my-study"), "--out", path("report.html"), "--static", "--json", path("report.json")});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto report = nlohmann::json::parse(read_file(path("report.json")));
  for (const char* recipe : {"MINE+SPFH", "MINE+ALL"}) {
    const std::set<std::string> charts = charts_with(report, recipe);
    for (const char* chart : {"Figure 16", "Figure 17", "Figure 18", "Figure 19", "Figure 20", "Figure 22",
                              "All recipes against SAH+LSPH", "By kind of area and direction of rays"})
      EXPECT_TRUE(charts.contains(chart)) << recipe << " is not in " << chart;
    EXPECT_NE(read_file(path("report.html")).find(recipe), std::string::npos);
  }
}
#endif

TEST_F(ReportCommand, LeavesTheOldPageWhereTheDiskIsFull) {
  write_file(path("report.html"), "old");
  RunOptions limits;
  limits.file_size = 100;
  const RunResult result = run_program({"report", path("paper.csv"), "--out", path("report.html"), "--static"}, limits);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(read_file(path("report.html")), "old");
  EXPECT_EQ(names_in(folder_), (std::vector<std::string>{"paper.csv", "report.html"}));
}

}  // namespace
}  // namespace raygrain::test
