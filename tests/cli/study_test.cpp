// raygrain study as users run it: killed at random moments, continued, refused.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>

#include "base/random.h"
#include "cli/program.h"
#include "support/shared.h"

namespace raygrain::test {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::string cell;
  bool quoted = false;
  for (const char c : line) {
    quoted ^= c == '"';
    if (c == ',' && !quoted) {
      cells.push_back(cell);
      cell.clear();
    } else {
      cell += c;
    }
  }
  cells.push_back(cell);
  return cells;
}

/// The file without times and environment.
std::string deterministic(const std::string& path) {
  std::istringstream file(read_file(path));
  std::string line, result;
  std::vector<std::string> header;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = cells_of(line);
    if (header.empty()) header = cells;
    for (size_t i = 0; i < cells.size() && i < header.size(); ++i)
      if (!header[i].ends_with("_seconds") && header[i] != "cpu") result += cells[i] + ',';
    result += '\n';
  }
  return result;
}

std::vector<std::string> study_arguments(const std::string& folder, const std::string& jobs) {
  return {"study", "published", "--only", "Random100,Random1000", "--rays", "200", "--jobs", jobs,
          "--out", folder,      "--quiet"};
}

TEST(StudyProgram, GoesOnAfterAKillAtAnyMoment) {
  const TemporaryFolder folder;
  const std::string whole = folder.file("whole");
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run_program(study_arguments(whole, "1")).exit_code, 0);
  const std::chrono::duration<double> length = std::chrono::steady_clock::now() - begin;
  const std::string expected = deterministic(whole + "/results.csv");
  EXPECT_EQ(std::count(expected.begin(), expected.end(), '\n'), 1 + 2 * (4 * 4 + 4 * 5));
  size_t resumed = 0;
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const std::string out = folder.file(std::to_string(seed)), jobs = std::to_string(1 + seed % 3);
    {
      RunningProgram program(study_arguments(out, jobs), folder.file("output"), folder.file("errors"));
      std::this_thread::sleep_for(length * random.uniform(0.1, 0.9));
      program.send(SIGKILL);
      program.wait();
    }
    resumed += read_file(out + "/results.partial.csv").size() > 1000 ? 1 : 0;
    const RunResult result = run_program(study_arguments(out, jobs));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(deterministic(out + "/results.csv"), expected);
    EXPECT_EQ(names_in(out), std::vector<std::string>{"results.csv"});
  }
  EXPECT_GT(resumed, 0u) << "no kill came in the middle";
}

TEST(StudyProgram, RefusesBadInput) {
  const TemporaryFolder folder;
  write_file(folder.file("bad.json"), "{\"format\": \"raygrain-study\", \"version\": 1, \"name\": \"x\", }");
  struct Row {
    std::vector<std::string> arguments;
    int exit_code;
    std::string message;
  };
  for (const Row& row : std::vector<Row>{
           {{"study", "papers", "--out", folder.file("o")}, 2, "papers: is no study. Did you mean \"paper\"?"},
           {{"study", folder.file("none.json"), "--out", folder.file("o")}, 1, "none.json"},
           {{"study", folder.file("bad.json"), "--out", folder.file("o")}, 1, "bad.json:1:"},
           {{"study", "paper", "--scenes", folder.file("none"), "--out", folder.file("o")}, 1, "is no folder"},
           {{"study", "paper", "--only", "Random1", "--out", folder.file("o")},
            2,
            "Random1: is no scene of this study"},
           {{"study", "paper", "--rays", "0"}, 2, "--rays"},
           {{"study", "paper", "--jobs", "-1"}, 2, "--jobs"},
           {{"study", "paper", "--only", "Random100", "--out", folder.file("bad.json")}, 1, "bad.json"}}) {
    const RunResult result = run_program(row.arguments);
    EXPECT_EQ(result.exit_code, row.exit_code) << row.message;
    EXPECT_NE(result.errors.find(row.message), std::string::npos) << result.errors;
    EXPECT_FALSE(std::filesystem::exists(folder.file("o"))) << row.message;
  }
}

TEST(StudyProgram, SaysWhatIsLeftOutAndWhatCameOut) {
  const TemporaryFolder folder;
  const RunResult result = run_program({"study", "paper", "--rays", "50", "--out", folder.file("out"), "-j", "2"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("left out: Sponza: needs sponza.ply"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("paper: 64 rows"), std::string::npos);
  EXPECT_NE(result.output.find("prediction error, plane areas, matched rays: PAH "), std::string::npos);
}

}  // namespace
}  // namespace raygrain::test
