// Every other command, its help, and the library's formats as they come out of it.
#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "support/shared.h"

namespace raygrain::test {
namespace {

using Json = nlohmann::json;

size_t count_lines(const std::string& text) {
  return static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST(Help, EveryCommandExplainsItself) {
  const std::vector<std::vector<std::string>> commands{{},
                                                       {"compare"},
                                                       {"build"},
                                                       {"trace"},
                                                       {"explain"},
                                                       {"analyze"},
                                                       {"refit"},
                                                       {"recipes"},
                                                       {"report"},
                                                       {"scene"},
                                                       {"scene", "generate"},
                                                       {"scene", "convert"},
                                                       {"scene", "info"}};
  for (std::vector<std::string> arguments : commands) {
    SCOPED_TRACE(arguments.empty() ? "raygrain" : arguments.back());
    const bool has_options = !arguments.empty() && arguments.back() != "scene";
    arguments.push_back("--help");
    const RunResult result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.errors, "");
    EXPECT_GT(result.output.size(), 200u);
    if (!has_options) continue;
    for (const char* option : {"--quiet", "--threads", "--json", "--help"})
      EXPECT_NE(result.output.find(option), std::string::npos) << option;
  }
}

TEST(Version, IsOneLine) {
  const RunResult result = run_program({"--version"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(result.output.starts_with("raygrain 0.")) << result.output;
  EXPECT_EQ(count_lines(result.output), 1u);
}

TEST(Recipes, ListsWhatCompareKnows) {
  const RunResult result = run_program({"recipes"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  for (const char* name : {"SAH", "PAH", "SAMPLED", "LSPH", "SPFH", "ALL", "ROBIN", "paper", "binned"})
    EXPECT_NE(result.output.find(name), std::string::npos) << name;
  const Json json = Json::parse(run_program({"recipes", "--json", "-"}).output);
  for (const char* key : {"measures", "orientations", "builders"}) EXPECT_FALSE(json.at(key).empty()) << key;
}

TEST(Build, WritesATreeWithItsStatistics) {
  const TemporaryFolder folder;
  const std::string tree = folder.file("tree.json");
  const RunResult result = run_program({"build", kSmallScene, "--recipe", "PAH+ALL", "--area", "sun", "-o", tree});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("estimated_cost"), std::string::npos);
  const Json json = Json::parse(read_file(tree));
  EXPECT_EQ(json.at("format"), "raygrain-tree");
  EXPECT_EQ(json.at("info").at("rows").at(0).at("name"), "PAH+ALL");
  EXPECT_EQ(json.at("info").at("rows").at(0).at("nodes"), json.at("nodes").size());
}

TEST(Build, TakesTheWholeSceneWhereAsked) {
  const TemporaryFolder folder;
  const RunResult result = run_program(
      {"build", kSmallScene, "--recipe", "sah+lsph", "--whole", "-o", folder.file("tree.json"), "--json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const Json json = Json::parse(result.output);
  EXPECT_EQ(json.at("rows").at(0).at("area"), "");
  EXPECT_EQ(json.at("rows").at(0).at("triangles"), json.at("triangles"));
}

TEST(Build, TakesRecipesThatNeedSamples) {
  const TemporaryFolder folder;
  const RunResult result =
      run_program({"build", kSmallScene, "--recipe", "SAMPLED+ALL@binned", "-o", folder.file("tree.json")});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
}

TEST(Analyze, HasEveryMetricOfATree) {
  const TemporaryFolder folder;
  const std::string nodes = folder.file("nodes.csv");
  const RunResult result =
      run_program({"analyze", kSmallScene, "--recipe", "PAH+SPFH", "--rays", "500", "--nodes", nodes, "--json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const Json row = Json::parse(result.output).at("rows").at(0);
  for (const char* key : {"estimated_cost",
                          "real_cost",
                          "pruned_cost",
                          "cost_with_fallback",
                          "global_cost",
                          "hit_ratio",
                          "break_even_hit_ratio",
                          "overlap4",
                          "overlap7_culled",
                          "overlap",
                          "orientations_per_node",
                          "fallback_share",
                          "nodes",
                          "leaves",
                          "triangles_per_leaf",
                          "max_level",
                          "mean_leaf_depth",
                          "small_child_ratio",
                          "large_child_ratio",
                          "memory_bytes",
                          "paper_memory_bytes",
                          "build_seconds",
                          "top_level_leaves",
                          "top_level_false_candidates",
                          "top_level_memory_bytes",
                          "top_level_query_seconds"})
    EXPECT_TRUE(row.contains(key) && row.at(key).is_number()) << key;
  const std::string table = read_file(nodes);
  EXPECT_EQ(count_lines(table), row.at("nodes").get<size_t>() + 1);
  EXPECT_TRUE(table.starts_with("index,parent,level,"));
}

TEST(Analyze, ExplainsItsMetricsToPeople) {
  const RunResult result = run_program({"analyze", kSmallScene, "--recipe", "SAH+ALL@binned", "--rays", "100"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("Mean depth of a leaf"), std::string::npos);
  const RunResult whole = run_program({"analyze", kSmallScene, "--recipe", "SAH+ALL", "--whole"});
  EXPECT_EQ(whole.exit_code, 0) << whole.errors;
}

TEST(Trace, FindsTheHitsOfRaysFromAFile) {
  const TemporaryFolder folder;
  // The far triangles make room for the rays' origins in the sun's area.
  write_file(folder.file("quad.obj"),
             "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n"
             "v 90 0 -9\nv 91 0 -9\nv 90 1 -9\nf 4 5 6\nv 90 0 9\nv 91 0 9\nv 90 1 9\nf 7 8 9\n");
  write_file(folder.file("rays.csv"),
             "ox,oy,oz,dx,dy,dz,tmin,tmax\n1,1,-2,0,0,1,0,inf\n3,3,-2,0,0,1,0,inf\n1,2,2,0,0,-2,0,5\n");
  const std::string hits = folder.file("hits.csv");
  for (const std::vector<std::string>& areas : {std::vector<std::string>{}, {"--sun", "0,0,1"}}) {
    std::vector<std::string> arguments{
        "trace", folder.file("quad.obj"), "--rays", folder.file("rays.csv"), "-o", hits, "--verify", "--json", "-"};
    arguments.insert(arguments.end(), areas.begin(), areas.end());
    const RunResult result = run_program(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const Json json = Json::parse(result.output);
    EXPECT_EQ(json.at("rays"), 3);
    EXPECT_EQ(json.at("hits"), 2);
    EXPECT_EQ(json.at("mismatches"), 0);
    EXPECT_EQ(json.at("counters").at("local_hits") > 0, !areas.empty());
    std::istringstream lines(read_file(hits));
    std::string line;
    std::getline(lines, line);
    EXPECT_TRUE(line.starts_with("t,u,v,triangle")) << line;
    std::getline(lines, line);
    EXPECT_TRUE(line.starts_with("2,0.25,0.25,0")) << line;
    std::getline(lines, line);
    EXPECT_TRUE(line.starts_with("inf,0,0,-1")) << line;
    std::getline(lines, line);
    EXPECT_TRUE(line.starts_with("1,0.25,0.5,0")) << line;
  }
}

TEST(Trace, TakesTheRaysOfAScene) {
  const TemporaryFolder folder;
  const RunResult result =
      run_program({"trace", "procedural:random1000", "--set", "sun", "-o", folder.file("hits.csv"), "--verify"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_GT(count_lines(read_file(folder.file("hits.csv"))), 1000u);
}

TEST(Explain, SaysOfEachQuestionWhatItCostsAndSaves) {
  const RunResult result = run_program({"explain", kSmallScene, "--samples", "200", "--space", "none", "--json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const Json json = Json::parse(result.output);
  ASSERT_EQ(json.at("areas").size(), 1u);
  const Json& area = json.at("areas").at(0);
  EXPECT_EQ(area.at("name"), "sun");
  EXPECT_EQ(area.at("structures"), "coverage");
  const std::vector<std::string> names{"any hits together", "closest hits together", "any hits one by one",
                                       "closest hits one by one"};
  ASSERT_EQ(area.at("questions").size(), names.size());
  for (size_t i = 0; i < names.size(); ++i) {
    const Json& question = area.at("questions").at(i);
    EXPECT_EQ(question.at("question"), names[i]);
    EXPECT_EQ(question.at("rays"), 200);
    const double here = question.at("area_nanoseconds"), global = question.at("global_nanoseconds");
    EXPECT_GT(global, 0);
    const Json& answered = question.at("answered");
    const bool is_asked = answered.at("covered") > 0 || answered.at("local") > 0;
    EXPECT_EQ(question.at("break_even_rays").is_null(), !is_asked || here >= global);
  }
  EXPECT_EQ(json.at("rays"), 0);
}

TEST(Explain, TakesTreesInRaySpaceForIsotropicLight) {
  const RunResult result = run_program({"explain", kSmallScene, "--light", "1,30,2", "--samples", "20", "--space",
                                        "ray", "--density", "solid-angle", "--json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(Json::parse(result.output).at("areas").size(), 6u);
}

TEST(Explain, CountsTheRaysThatAreGiven) {
  const TemporaryFolder folder;
  write_file(folder.file("quad.obj"), "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nf 1 2 3\nf 1 3 4\n");
  std::string rays = "ox,oy,oz,dx,dy,dz,tmin,tmax\n";
  for (int i = 0; i < 100; ++i)  // sixty to the sun, thirty nobody's, ten of no direction
    rays += fmt::format("{},1,-2,{}\n", i % 7, i < 60 ? "0,0,-1,0,inf" : i < 90 ? "1,0,0,0,inf" : "0,0,0,0,inf");
  write_file(folder.file("rays.csv"), rays);
  std::vector<std::string> arguments{"explain", folder.file("quad.obj"),
                                     "--sun",   "0,0,1",
                                     "--rays",  folder.file("rays.csv"),
                                     "--any",   "--samples",
                                     "50",      "--space",
                                     "none"};
  const RunResult text = run_program(arguments);
  ASSERT_EQ(text.exit_code, 0) << text.errors;
  EXPECT_NE(text.output.find(" pays after "), std::string::npos) << text.output;
  EXPECT_NE(text.output.find("of 100 rays: "), std::string::npos) << text.output;
  arguments.insert(arguments.end(), {"--json", "-"});
  const Json json = Json::parse(run_program(arguments).output);
  const Json& area = json.at("areas").at(0);
  EXPECT_EQ(json.at("rays"), 100);
  EXPECT_EQ(json.at("invalid_rays"), 10);
  const uint64_t covered = area.at("answered").at("covered"), global = area.at("answered").at("global");
  EXPECT_EQ(covered + global, 60u);
  EXPECT_EQ(json.at("covered"), covered);
  EXPECT_EQ(json.at("global_searches"), 90 - covered);
  for (const char* searches : {"local_searches", "columns", "cones"}) EXPECT_EQ(json.at(searches), 0) << searches;
  EXPECT_EQ(area.at("share"), static_cast<double>(covered) / 100);
}

TEST(SceneCommands, GenerateConvertAndDescribe) {
  const TemporaryFolder folder;
  const std::string first = folder.file("city.json"), second = folder.file("city.obj");
  RunResult result = run_program({"scene", "generate", "city", "--size", "5", "--seed", "3", "-o", first});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{"city.json", "city.ply"}));
  result = run_program({"scene", "convert", first, "-o", second});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const Json original =
      Json::parse(run_program({"scene", "info", "procedural:city?size=5&seed=3", "--json", "-"}).output);
  const Json stored = Json::parse(run_program({"scene", "info", first, "--json", "-"}).output);
  const Json converted = Json::parse(run_program({"scene", "info", second, "--json", "-"}).output);
  EXPECT_EQ(stored.at("areas").at(0).at("name"), "sun");
  EXPECT_EQ(original.at("triangles"), stored.at("triangles"));
  EXPECT_EQ(original.at("triangles"), converted.at("triangles"));
  EXPECT_EQ(original.at("bounds"), converted.at("bounds"));
  EXPECT_NE(run_program({"scene", "info", second}).output.find(" triangles, "), std::string::npos);
}

TEST(SceneCommands, InfoCountsTheRaysOfEverySet) {
  const TemporaryFolder folder;
  const std::string scene = folder.file("scene.json");
  write_file(folder.file("rays.csv"), "ox,oy,oz,dx,dy,dz\n0,0,0,0,0,1\n0,0,0,0,1,0\n0,0,0,1,0,0\n");
  write_file(scene, R"({"format": "raygrain-scene", "version": 1, "procedural": "procedural:random100", "rays": [
    {"name": "view", "camera": {"eye": [0, 0, 9], "target": [0, 0, 0], "width": 320, "height": 200}},
    {"name": "list", "rays": [[0, 0, 0, 0, 0, 1], [0, 0, 0, 0, 1, 0]]}, {"name": "table", "file": "rays.csv"},
    {"name": "matched", "surface": {"direction": [0, -1, 0]}, "count": 40}]})");
  const RunResult text = run_program({"scene", "info", scene});
  ASSERT_EQ(text.exit_code, 0) << text.errors;
  const Json sets = Json::parse(run_program({"scene", "info", scene, "--json", "-"}).output).at("ray_sets");
  const std::vector<std::pair<std::string, size_t>> expected{
      {"view", 64000}, {"list", 2}, {"table", 3}, {"matched", 40}};
  ASSERT_EQ(sets.size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    const auto& [name, count] = expected[i];
    EXPECT_NE(text.output.find("rays " + name + " (" + std::to_string(count) + ")"), std::string::npos) << text.output;
    EXPECT_EQ(sets[i], (Json{{"name", name}, {"count", count}}));
  }
}

TEST(SceneCommands, GenerateTakesTheNameOfAProceduralScene) {
  const TemporaryFolder folder;
  const RunResult a =
      run_program({"scene", "generate", "procedural:terrain?size=9&seed=2", "-o", folder.file("a.ply")});
  const RunResult b =
      run_program({"scene", "generate", "terrain", "--size", "9", "--seed", "2", "-o", folder.file("b.ply")});
  ASSERT_EQ(a.exit_code, 0) << a.errors;
  ASSERT_EQ(b.exit_code, 0) << b.errors;
  EXPECT_TRUE(read_file(folder.file("a.ply")) == read_file(folder.file("b.ply")));
}

}  // namespace
}  // namespace raygrain::test
