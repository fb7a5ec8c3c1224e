// The main job as a whole: table, JSON, CSV and pictures.
#include <algorithm>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "support/shared.h"

namespace raygrain::test {
namespace {

using Json = nlohmann::json;

const char* const kRowKeys[] = {"name",
                                "area",
                                "estimated_cost",
                                "real_cost",
                                "pruned_cost",
                                "cost_with_fallback",
                                "hit_ratio",
                                "overlap",
                                "orientations_per_node",
                                "fallback_share",
                                "nodes",
                                "max_level",
                                "mean_leaf_depth",
                                "build_seconds",
                                "trace_seconds",
                                "memory_bytes",
                                "mismatches"};

uint32_t big_endian(const std::string& bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<uint8_t>(bytes.at(at + i));
  return value;
}

void expect_png(const std::string& path, uint32_t least_width, uint32_t least_height) {
  SCOPED_TRACE(path);
  const std::string bytes = read_file(path);
  ASSERT_GT(bytes.size(), 1000u);
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_GE(big_endian(bytes, 16), least_width);
  EXPECT_GE(big_endian(bytes, 20), least_height);
}

TEST(Compare, WritesTableJsonCsvAndPictures) {
  const TemporaryFolder folder;
  const std::string out = folder.file("new/result");
  const RunResult result =
      run_program({"compare", kSmallScene, "--rays", "500", "--seed", "7", "--verify", "--out", out});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  EXPECT_EQ(names_in(out), (std::vector<std::string>{"compare.csv", "compare.json", "sun-cost.png", "sun-depth.png"}));
  for (const std::string& name : names_in(out))
    EXPECT_NE(result.output.find(out + "/" + name), std::string::npos) << "names every file it wrote";
  expect_png(out + "/sun-depth.png", 300, 200);
  expect_png(out + "/sun-cost.png", 600, 200);

  const Json json = Json::parse(read_file(out + "/compare.json"));
  EXPECT_EQ(json.at("seed"), 7);
  EXPECT_GT(json.at("triangles"), 20);
  EXPECT_TRUE(json.at("scene").is_string());
  for (const char* key : {"commit", "compiler", "cpu", "threads"})
    EXPECT_TRUE(json.at("environment").contains(key)) << key;
  std::vector<std::string> names;
  for (const Json& row : json.at("rows")) {
    names.push_back(row.at("name"));
    for (const char* key : kRowKeys) EXPECT_TRUE(row.contains(key) && !row.at(key).is_null()) << key;
    EXPECT_EQ(row.at("area"), "sun");
    EXPECT_EQ(row.at("mismatches"), 0);
    EXPECT_NE(result.output.find(names.back()), std::string::npos);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"SAH+LSPH", "SAH+SPFH", "PAH+LSPH", "PAH+SPFH", "SAH+ALL", "PAH+ALL"}));
  const std::string csv = read_file(out + "/compare.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
  EXPECT_TRUE(csv.starts_with("name,area,estimated_cost,real_cost,pruned_cost,"));
}

TEST(Compare, JsonOnStandardOutputStandsAlone) {
  const RunResult result =
      run_program({"compare", kSmallScene, "--rays", "100", "--recipes", "SAH+ALL,PAH+ALL@binned", "--json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const Json json = Json::parse(result.output);
  ASSERT_EQ(json.at("rows").size(), 2u);
  EXPECT_EQ(json.at("rows")[1].at("name"), "PAH+ALL@binned");
}

TEST(Compare, TakesSunLightAndCamera) {
  const auto areas_of = [](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"compare",          kSmallScene, "--rays", "200", "--recipes",
                                       "SAH+LSPH,PAH+ALL", "--verify",  "--json", "-"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const RunResult result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    std::set<std::string> areas;
    const Json json = Json::parse(result.output);
    for (const Json& row : json.at("rows")) {
      areas.insert(row.at("area"));
      EXPECT_EQ(row.at("mismatches"), 0) << row;
    }
    return areas;
  };
  EXPECT_EQ(areas_of({"--sun", "-.5,-0.8,0.1"}), std::set<std::string>{"sun"});
  EXPECT_EQ(areas_of({"--camera", "-30,20,-30", "0,0,0", "--fov", "70", "--aspect", "2"}),
            std::set<std::string>{"camera"});
  const std::set<std::string> light = areas_of({"--light", "1,30,1"});
  EXPECT_TRUE(light.contains("light-y")) << "the face that looks down";
  EXPECT_LE(light.size(), 6u);
}

TEST(Compare, LeavesOutFacesOfALightThatReachNothing) {
  const RunResult result =
      run_program({"compare", kSmallScene, "--rays", "50", "--recipes", "SAH+ALL", "--light", "0,10000,0"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("no triangle lies there: "), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("light+y"), std::string::npos);
  const RunResult quiet =
      run_program({"compare", kSmallScene, "--rays", "50", "--recipes", "SAH+ALL", "--light", "0,10000,0", "--quiet"});
  EXPECT_EQ(quiet.output.find("light+y"), std::string::npos) << "--quiet leaves notes out";
}

TEST(Compare, TreatsEmptyAreasOfAFileAlike) {
  const auto plane = [](const char* name, const char* center) {
    return std::string(R"({"name": ")") + name + R"(", "plane": {"center": )" + center +
           R"(, "direction": [0, -1, 0], "half_width": 20, "half_height": 20, "depth": 90}})";
  };
  const TemporaryFolder folder;
  const std::string areas = folder.file("areas.json"), far = plane("far", "[90000, 0, 0]");
  const auto compare = [&](const std::string& list) {
    write_file(areas, R"({"format": "raygrain-areas", "version": 1, "areas": [)" + list + "]}");
    return run_program({"compare", kSmallScene, "--rays", "50", "--recipes", "SAH+LSPH", "--areas", areas});
  };
  const RunResult one = compare(far + ", " + plane("near", "[0, 80, 0]"));
  ASSERT_EQ(one.exit_code, 0) << one.errors;
  EXPECT_NE(one.output.find("no triangle lies there: far"), std::string::npos) << one.output;
  EXPECT_NE(one.output.find("near: SAH+LSPH is best"), std::string::npos) << one.output;
  EXPECT_EQ(one.output.find("far:"), std::string::npos) << one.output;
  const RunResult none = compare(far);
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.errors.find("no triangle lies in the influence areas"), std::string::npos) << none.errors;
}

TEST(Compare, IsTheSameForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  Json results[2];
  for (int i = 0; i < 2; ++i) {
    const std::string out = folder.file(std::to_string(i));
    const RunResult result = run_program(
        {"compare", kSmallScene, "--rays", "300", "--threads", std::to_string(i + 1), "--out", out, "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    results[i] = Json::parse(read_file(out + "/compare.json"));
    EXPECT_EQ(results[i].at("environment").at("threads"), i + 1);
    results[i].at("environment").erase("threads");
    for (Json& row : results[i].at("rows"))
      for (auto item = row.begin(); item != row.end();)
        item = item.key().ends_with("_seconds") ? row.erase(item) : std::next(item);
  }
  EXPECT_EQ(results[0], results[1]);
  for (const char* picture : {"/sun-depth.png", "/sun-cost.png"})
    EXPECT_TRUE(read_file(folder.file("0") + picture) == read_file(folder.file("1") + picture)) << picture;
}

TEST(Compare, EndsQuietlyWhenNobodyReads) {
  const TemporaryFolder folder;
  RunOptions options;
  options.closed_reader = true;
  const RunResult result = run_program({"compare", kSmallScene, "--rays", "50", "--out", folder.file("out")}, options);
  EXPECT_EQ(result.exit_code, 141);
  EXPECT_EQ(result.errors, "");
  EXPECT_EQ(names_in(folder.file("out")).size(), 4u) << "the files are written before the table";
}

}  // namespace
}  // namespace raygrain::test
