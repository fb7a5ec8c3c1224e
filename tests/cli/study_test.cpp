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
    EXPECT_EQ(names_in(out), (std::vector<std::string>{"results.csv", "study.txt"}));
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
            "\"Random1\": is no scene of this study"},
           {{"study", "paper", "--only", "Wood", "--out", folder.file("o")},
            1,
            "their models are missing (Wood: needs woods.obj). Name the folder that holds them with --scenes"},
           {{"study", "stress", "--only", "Wood", "--out", folder.file("o")}, 1, "needs woods.obj"},
           {{"study", "scaling", "--only", "City 3", "--out", folder.file("o")}, 2, "\"City 3\": is no scene"},
           {{"study", "areas", "--only", "Village", "--out", folder.file("o")}, 2, "\"Village\": is no scene"},
           {{"study", "areas", "--quick", "--only", "Sponza", "--out", folder.file("o")}, 2, "\"Sponza\": is no scene"},
           {{"study", "scaling", "--quick", "--only", "City 8", "--out", folder.file("o")},
            2,
            "\"City 8\": is no scene"},
           {{"study", "visibility", "--quick", "--only", "Cottage", "--out", folder.file("o")},
            2,
            "\"Cottage\": is no scene of this study. Known: City, Forest, Terrain, Sponza, Crowd"},
           {{"study", "visibility", "--quick", "--only", "", "--out", folder.file("o")},
            2,
            "\"\": is no scene of this study"},
           {{"study", "visibility", "--quick", "--only", "Crowd", "--out", folder.file("o")}, 1, "Crowd: needs"},
           {{"study", "paper", "--rays", "0"}, 2, "--rays"},
           {{"study", "paper", "--jobs", "-1"}, 2, "--jobs"},
           {{"study", "paper", "--only", "Random100", "--out", folder.file("bad.json")}, 1, "bad.json"}}) {
    const RunResult result = run_program(row.arguments);
    EXPECT_EQ(result.exit_code, row.exit_code) << row.message;
    EXPECT_NE(result.errors.find(row.message), std::string::npos) << result.errors;
    EXPECT_FALSE(std::filesystem::exists(folder.file("o"))) << row.message;
  }
}

constexpr const char* kGrid = R"({"format": "raygrain-study", "version": 1, "name": "mine/own",
  "scenes": [{"paper": "Random100"}, {"paper": "Random1000"}],
  "recipes": ["SAH+LSPH", {"recipe": "PAH+SPFH", "parameters": {"bins": 40}},
              {"recipe": "PAH+ALL@sweep", "name": "sweep"}], "rays": [{"count": 3000}]})";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// A bad file is bad data; a flag that does not fit it is bad usage. Nothing runs, no folder is made.
TEST(StudyProgram, RefusesBadStudyFilesBeforeAnyRow) {
  const TemporaryFolder folder;
  struct Row {
    const char *from, *to, *message;
  };
  for (const Row& row :
       std::vector<Row>{{"\"bins\": 40", "\"bins\": 1", "#/recipes/1/parameters/bins: is out of range"},
                        {"\"mine/own\"", "\"a\\nb\"", "#/name: has control characters"},
                        {"\"Random1000\"", "\"Random100\"", "two scenes are named"},
                        {"\"Random1000\"", "\"Random2000\"", "is no scene of this study"},
                        {"PAH+SPFH", "PAH+SPF", "#/recipes/1/recipe: unknown name"},
                        {"\"SAH+LSPH\"", "\"DIR+LSPH\"", "DIR needs parallel rays"}}) {
    write_file(folder.file("grid.json"), replaced(kGrid, row.from, row.to));
    const RunResult result = run_program({"study", folder.file("grid.json"), "--out", folder.file("o"), "-j", "2"});
    EXPECT_EQ(result.exit_code, 1) << row.message;
    EXPECT_NE(result.errors.find(row.message), std::string::npos) << result.errors;
    EXPECT_NE(result.errors.find("grid.json"), std::string::npos) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1);
    EXPECT_FALSE(std::filesystem::exists(folder.file("o"))) << row.message;
  }
  write_file(folder.file("grid.json"), kGrid);
  const RunResult other = run_program({"study", folder.file("grid.json"), "--only", "Wood", "--out", folder.file("o")});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.errors.find("\"Wood\": is no scene of this study"), std::string::npos) << other.errors;
}

/// Rows of two grids must never stand in one file: not after a kill, not after the end.
TEST(StudyProgram, RefusesAChangedFileInTheSameFolder) {
  const TemporaryFolder folder;
  const std::string grid = folder.file("grid.json"), out = folder.file("out");
  const std::vector<std::string> arguments{"study", grid, "--out", out, "--quiet"};
  write_file(grid, kGrid);
  {
    RunningProgram program(arguments, folder.file("output"), folder.file("errors"));
    while (program.is_running() && read_file(out + "/results.partial.csv").size() < 200)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    program.send(SIGKILL);
    program.wait();
  }
  ASSERT_TRUE(std::filesystem::exists(out + "/results.partial.csv")) << "the kill came too late";
  const std::string partial = read_file(out + "/results.partial.csv");
  write_file(grid, replaced(kGrid, "\"bins\": 40", "\"bins\": 32"));
  const RunResult changed = run_program(arguments);
  EXPECT_EQ(changed.exit_code, 2);
  EXPECT_NE(changed.errors.find("holds an unfinished run of another study, or of this one with other options"),
            std::string::npos)
      << changed.errors;
  EXPECT_EQ(read_file(out + "/results.partial.csv"), partial);

  write_file(grid, kGrid);
  ASSERT_EQ(run_program(arguments).exit_code, 0);
  const std::string finished = read_file(out + "/results.csv");
  for (const std::vector<std::string>& other :
       std::vector<std::vector<std::string>>{{"study", "paper", "--only", "Random100", "--out", out},
                                             {"study", grid, "--out", out, "--only", "Random100"},
                                             {"study", grid, "--out", out, "--seed", "2"}}) {
    const RunResult result = run_program(other);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.errors.find("results.csv: holds the results of another study"), std::string::npos)
        << result.errors;
    EXPECT_NE(result.errors.find("Choose another folder with --out"), std::string::npos) << result.errors;
    EXPECT_EQ(read_file(out + "/results.csv"), finished);
  }
  EXPECT_EQ(run_program(arguments).exit_code, 0) << "the same study may run again";
}

TEST(StudyProgram, GivesEachStudyAFolderOfItsOwn) {
  const TemporaryFolder folder;
  RunOptions there;
  there.folder = folder.path();
  const RunResult paper = run_program({"study", "paper", "--only", "Random100", "--rays", "20"}, there);
  EXPECT_EQ(paper.exit_code, 0) << paper.errors;
  EXPECT_NE(paper.output.find("paper: 32 rows in study/paper/results.csv"), std::string::npos) << paper.output;
  write_file(folder.file("grid.json"), kGrid);
  const RunResult own = run_program({"study", "grid.json", "--only", "Random100", "--quiet"}, there);
  EXPECT_EQ(own.exit_code, 0) << own.errors;
  EXPECT_EQ(names_in(folder.file("study")), (std::vector<std::string>{"mine_own", "paper"}));
}

/// Combinations with other tests than the others have means of their own.
TEST(StudyProgram, SummarisesEveryRecipeOverAllItsTests) {
  const TemporaryFolder folder;
  const RunResult result = run_program(
      {"study", "published", "--only", "Random100", "--rays", "100", "--out", folder.file("out"), "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const size_t all = result.output.find("means over the 8 tests of these recipes"),
               points = result.output.find("means over the 4 tests of these recipes");
  ASSERT_NE(all, std::string::npos) << result.output;
  ASSERT_NE(points, std::string::npos) << result.output;
  const std::string first = result.output.substr(all, points - all), second = result.output.substr(points);
  for (const char* combo : {"PAH+SPFH", "PAH+LSPH ", "SAH+SPFH", "SAH+LSPH"})
    EXPECT_NE(first.find(combo), std::string::npos) << combo;
  EXPECT_EQ(first.find("PAH+LSPH-as-published"), std::string::npos);
  EXPECT_NE(second.find("PAH+LSPH-as-published"), std::string::npos);
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
