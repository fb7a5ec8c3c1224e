// Disks that are full, folders that are read-only, memory that is short: each is success, or an error in one line and
// exit code 1, and outputs are whole or absent.
#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "cli/program.h"
#include "support/mesh_families.h"
#include "support/shared.h"

namespace raygrain::test {
namespace {

/// IN stands for a folder with inputs, OUT for one that results go to.
struct Row {
  std::string name;
  std::vector<std::string> arguments;
};

std::vector<Row> writing_commands() {
  return {
      {"tree", {"build", kSmallScene, "--recipe", "SAH+ALL@binned", "--whole", "-o", "OUT/tree.rgt"}},
      {"tree JSON", {"build", kSmallScene, "--recipe", "SAH+ALL@binned", "--whole", "-o", "OUT/tree.json"}},
      {"analysis", {"analyze", kSmallScene, "--recipe", "SAH+ALL@binned", "--whole", "--nodes", "OUT/nodes.csv"}},
      {"hits", {"trace", kSmallScene, "--set", "sun", "-o", "OUT/hits.csv", "--json", "OUT/trace.json"}},
      {"explanation", {"explain", kSmallScene, "--samples", "10", "--json", "OUT/explanation.json"}},
      {"refitted tree", {"refit", "IN/mesh.ply", "--tree", "IN/tree.rgt", "-o", "OUT/tree.rgt"}},
      {"mesh", {"scene", "convert", "IN/mesh.ply", "-o", "OUT/mesh.obj"}},
      {"scene", {"scene", "generate", kSmallScene, "-o", "OUT/scene.json"}},
      {"comparison", {"compare", kSmallScene, "--rays", "100", "--recipes", "SAH+ALL@binned", "--out", "OUT/compared"}},
      {"report", {"report", "IN/compare.csv", "--static", "--out", "OUT/page.html", "--markdown", "OUT/page.md"}},
      {"view",
       {"view", kSmallScene, "--recipes", "SAH+ALL@binned", "--template", "IN/page.html", "--out", "OUT/v.html"}},
      {"study", {"study", "published", "--only", "Random100", "--rays", "50", "--out", "OUT/study", "--quiet"}},
  };
}

/// A folder with inputs, and one for outputs.
class Faults : public testing::Test {
 protected:
  Faults() {
    std::filesystem::create_directory(folder_.file("in"));
    std::filesystem::create_directory(out());
    run({"scene", "convert", kSmallScene, "-o", "IN/mesh.ply"}, {});
    run({"build", "IN/mesh.ply", "--recipe", "SAH+ALL@binned", "-o", "IN/tree.rgt"}, {});
    write_file(folder_.file("in/compare.csv"), "name,area,real_cost,pruned_cost\nSAH+ALL,sun,3,2\nPAH+ALL,sun,2,1\n");
    write_file(folder_.file("in/page.html"), "<!doctype html>@RAYGRAIN_VIEW@|@RAYGRAIN_BLOBS@");
  }

  std::string out() const { return folder_.file("out"); }

  RunResult run(std::vector<std::string> arguments, const RunOptions& options) const {
    for (std::string& argument : arguments) {
      if (argument.starts_with("IN/")) argument.replace(0, 2, folder_.file("in"));
      if (argument.starts_with("OUT/")) argument.replace(0, 3, out());
    }
    return run_program(arguments, options);
  }

  /// Success, or one line that says where, what and how to mend it.
  static void expect_clear(const RunResult& result) {
    if (result.exit_code == 0) return;
    EXPECT_EQ(result.exit_code, 1) << result.errors;
    EXPECT_TRUE(result.errors.starts_with("raygrain: error: ")) << result.errors;
    EXPECT_EQ(result.errors.find('\n'), result.errors.size() - 1) << result.errors;
  }

  /// Every file is as long as in a run without faults (those that hold times: is complete), none is unfinished.
  void expect_whole_files() const {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(out())) {
      const std::string path = entry.path().string(), name = entry.path().filename().string();
      if (entry.is_directory() || name == "results.partial.csv") continue;  // a study in progress
      EXPECT_FALSE(name.starts_with(".")) << path;
      const std::string content = read_file(path);
      if (name.ends_with(".json")) {
        EXPECT_TRUE(nlohmann::json::accept(content)) << path;
      } else if (name.ends_with(".png")) {
        EXPECT_EQ(content.substr(content.size() - 8, 4), "IEND") << path;
      } else if (name.ends_with(".rgt") || name.ends_with(".ply")) {
        const std::string expected = folder_.file(name.ends_with(".rgt") ? "in/tree.rgt" : "in/mesh.ply");
        EXPECT_EQ(content.size(), std::filesystem::file_size(expected)) << path;
      } else {
        EXPECT_TRUE(content.ends_with("\n") || content.ends_with("|") || content.ends_with("\"")) << path;
      }
    }
  }

  void clear() const {
    std::filesystem::remove_all(out());
    std::filesystem::create_directory(out());
  }

  TemporaryFolder folder_;
};

TEST_F(Faults, FullDisks) {
  for (const Row& row : writing_commands())
    for (const rlim_t bytes : {rlim_t{0}, rlim_t{5000}, rlim_t{70000}}) {
      SCOPED_TRACE(row.name + ", " + std::to_string(bytes) + " bytes a file");
      clear();
      RunOptions options;
      options.file_size = bytes;
      // Messages must fit; the program's own files start at other places.
      options.standard_output = "/dev/null";
      options.standard_error = "/dev/null";
      const RunResult result = run(row.arguments, options);
      EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1) << result.exit_code;
      if (bytes == 0) {
        EXPECT_EQ(result.exit_code, 1);
      }
      expect_whole_files();
    }
}

TEST_F(Faults, ReadOnlyFolders) {
  ::chmod(folder_.path().c_str(), 0755);
  ::chmod(folder_.file("in").c_str(), 0755);
  ::chmod(out().c_str(), 0555);
  RunOptions options;
  options.unprivileged = true;  // nothing is read-only for root
  if (run({"--version"}, options).exit_code != 0) GTEST_SKIP() << "another user cannot start the program here";
  for (const Row& row : writing_commands()) {
    SCOPED_TRACE(row.name);
    const RunResult result = run(row.arguments, options);
    EXPECT_EQ(result.exit_code, 1) << result.errors;
    expect_clear(result);
    EXPECT_NE(result.errors.find(out()), std::string::npos) << result.errors;
    EXPECT_TRUE(names_in(out()).empty());
  }
}

TEST_F(Faults, LittleMemory) {
  constexpr rlim_t kMiB = rlim_t{1} << 20;
  std::vector<Row> rows = writing_commands();
  rows.push_back({"import", {"scene", "info", "IN/mesh.ply"}});
  size_t refused = 0, done = 0;
  const rlim_t step = (120 / seed_count(2)) * kMiB;
  for (const Row& row : rows)
    for (rlim_t bytes = 30 * kMiB; bytes < 280 * kMiB; bytes += step) {
      SCOPED_TRACE(row.name + ", " + std::to_string(bytes / kMiB) + " MiB");
      clear();
      RunOptions options;
      options.memory = bytes;
      const RunResult result = run(row.arguments, options);
      if (result.exit_code == 127) continue;  // too little to load the program
      expect_clear(result);
      expect_whole_files();
      ++(result.exit_code == 0 ? done : refused);
    }
  EXPECT_GT(done, 0u);
  EXPECT_GT(refused, 0u);
}

}  // namespace
}  // namespace raygrain::test
