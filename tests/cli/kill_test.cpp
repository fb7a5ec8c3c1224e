// SIGKILL at random moments: whoever reads sees the old file or the new one, whole; a study loses no finished row.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "cli/program.h"
#include "support/mesh_families.h"
#include "support/shared.h"

namespace raygrain::test {
namespace {

using Seconds = std::chrono::duration<double>;

/// A command, the file that it writes, and how to tell a whole one.
struct Writer {
  std::string name;
  std::vector<std::string> arguments;  // OUT stands for the output's path
  std::string file;                    // of the output, below OUT where that is a folder
  std::function<bool(const std::string& content)> is_whole;
};

bool is_json(const std::string& content) {
  return nlohmann::json::accept(content);
}
std::function<bool(const std::string&)> ends_with(const std::string& end) {
  return [end](const std::string& content) { return content.ends_with(end); };
}

/// Each takes some tenths of a second. Trees and meshes are the same bytes every time; what holds times is JSON, HTML.
std::vector<Writer> writers(const TemporaryFolder& folder) {
  const std::string city = "procedural:city?size=12";
  const std::string results = folder.file("input.csv");
  std::string table = "study,scene,kind,variant,recipe,setting,ray_set,seed,repeat,real_cost,pruned_cost\n";
  for (int seed = 1; seed <= 2000; ++seed)
    for (const char* recipe : {"SAH+ALL", "PAH+ALL"})
      table += std::string("s,City,plane,sun,") + recipe + ",,matched," + std::to_string(seed) + ",1,5,4\n";
  write_file(results, table);
  const std::string page = folder.file("page.html");
  write_file(page, "<!doctype html>@RAYGRAIN_VIEW@|@RAYGRAIN_BLOBS@</html>");
  return {
      {"tree", {"build", city, "--recipe", "SAH+ALL@binned", "--whole", "-o", "OUT.rgt", "--quiet"}, ".rgt", {}},
      {"tree JSON", {"build", city, "--recipe", "SAH+ALL@binned", "--whole", "-o", "OUT.json"}, ".json", is_json},
      {"mesh", {"scene", "convert", city, "-o", "OUT.ply"}, ".ply", {}},
      {"comparison",
       {"compare", city, "--rays", "2000", "--recipes", "SAH+ALL@binned,PAH+ALL@binned", "--out", "OUT"},
       "/compare.json",
       is_json},
      {"view",
       {"view", city, "--recipes", "SAH+ALL@binned", "--template", page, "--out", "OUT.html"},
       ".html",
       ends_with("</html>")},
      {"report", {"report", results, "--static", "--out", "OUT.html"}, ".html", ends_with("</html>\n")},
  };
}

std::vector<std::string> with_output(std::vector<std::string> arguments, const std::string& out) {
  for (std::string& argument : arguments)
    if (argument.starts_with("OUT")) argument.replace(0, 3, out);
  return arguments;
}

/// Names in a folder and below it that are neither whole outputs' nor unfinished files', which are hidden.
size_t count_hidden(const std::string& folder) {
  size_t hidden = 0;
  for (const std::string& name : names_in(folder)) hidden += name.starts_with(".raygrain-") ? 1 : 0;
  return hidden;
}

TEST(Kill, LeavesTheOldFileOrTheNewOne) {
  const TemporaryFolder folder;
  size_t in_the_middle = 0;
  for (const Writer& writer : writers(folder)) {
    SCOPED_TRACE(writer.name);
    const std::string out = folder.file("out"), path = out + writer.file;
    const auto begin = std::chrono::steady_clock::now();
    const RunResult whole = run_program(with_output(writer.arguments, out));
    ASSERT_EQ(whole.exit_code, 0) << whole.errors;
    const Seconds length = std::chrono::steady_clock::now() - begin;
    const std::string expected = read_file(path);
    ASSERT_TRUE(writer.is_whole ? writer.is_whole(expected) : !expected.empty());
    for (uint64_t seed = 1; seed <= seed_count(2); ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      Random random(seed);
      const bool exists = random.below(2) == 0;  // else the file is new
      if (exists)
        write_file(path, "old\n");
      else
        std::filesystem::remove(path);
      RunningProgram program(with_output(writer.arguments, out), folder.file("output"), folder.file("errors"));
      std::this_thread::sleep_for(length * random.uniform(0, 1.1));
      program.send(SIGKILL);
      in_the_middle += program.wait() == -SIGKILL ? 1 : 0;
      const std::string content = read_file(path);
      if (content == (exists ? "old\n" : "")) continue;
      EXPECT_TRUE(writer.is_whole ? writer.is_whole(content) : content == expected) << content.size() << " bytes";
    }
    EXPECT_LE(count_hidden(folder.path()) + count_hidden(out), seed_count(2) * 5);  // hidden: no reader takes them
  }
  EXPECT_GT(in_the_middle, 0u);
}

/// Someone who reads all the time.
TEST(Kill, AReaderNeverSeesHalfAFile) {
  const TemporaryFolder folder;
  const std::string path = folder.file("mesh.ply");
  const std::vector<std::string> small{"scene", "convert", "procedural:random100", "-o", path, "--quiet"};
  const std::vector<std::string> large{"scene", "convert", "procedural:city?size=12", "-o", path, "--quiet"};
  ASSERT_EQ(run_program(large).exit_code, 0);
  const std::string second = read_file(path);
  ASSERT_EQ(run_program(small).exit_code, 0);
  const std::string first = read_file(path);
  size_t reads = 0;
  for (uint64_t seed = 1; seed <= seed_count(2); ++seed) {
    Random random(seed);
    for (const auto& arguments : {large, small}) {
      RunningProgram program(arguments, folder.file("output"), folder.file("errors"));
      const auto end = std::chrono::steady_clock::now() + Seconds(random.uniform(0.02, 0.6));
      while (program.is_running() && std::chrono::steady_clock::now() < end) {
        const std::string content = read_file(path);
        ASSERT_TRUE(content == first || content == second) << content.size() << " bytes, seed " << seed;
        ++reads;
      }
    }
  }
  EXPECT_GT(reads, 0u);
}

std::vector<std::string> lines_of(const std::string& path) {
  std::istringstream file(read_file(path));
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line) && !file.eof();) lines.push_back(line);  // the last one ends, too
  return lines;
}

/// Finished rows hold times: only a row that was kept is in the end the same.
TEST(Kill, AStudyKeepsEveryFinishedRow) {
  const TemporaryFolder folder;
  const std::string out = folder.file("out");
  const auto arguments = [&](const std::string& jobs) {
    return std::vector<std::string>{"study",  "published", "--only", "Random100", "--rays", "200",
                                    "--jobs", jobs,        "--out",  out,         "--quiet"};
  };
  size_t kept = 0;
  for (uint64_t seed = 1; seed <= seed_count(2); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::filesystem::remove_all(out);
    {
      RunningProgram program(arguments(std::to_string(1 + seed % 2)), folder.file("output"), folder.file("errors"));
      std::this_thread::sleep_for(Seconds(random.uniform(0.05, 0.5)));
      program.send(SIGKILL);
      program.wait();
    }
    std::vector<std::string> finished = lines_of(out + "/results.partial.csv");
    if (!finished.empty()) finished.erase(finished.begin());  // the title
    const RunResult result = run_program(arguments("1"));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const std::vector<std::string> all = lines_of(out + "/results.csv");
    for (const std::string& row : finished) EXPECT_EQ(std::count(all.begin(), all.end(), row), 1) << row;
    EXPECT_EQ(all.size(), size_t{1 + 4 * 4 + 4 * 5});
    kept += finished.size();
  }
  RecordProperty("kept", static_cast<int>(kept));
}

}  // namespace
}  // namespace raygrain::test
