// No command writes over what it reads, or one of its results over another: nothing is lost, whatever the names look
// like.
#include <filesystem>
#include <map>

#include <gtest/gtest.h>

#include "cli/program.h"
#include "support/shared.h"

namespace raygrain::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kQuad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";

class SeparateFiles : public testing::Test {
 protected:
  void SetUp() override {
    write_file(path("quad.obj"), kQuad);
    write_file(path("res.csv"), "scene,kind,variant,combo,pruned_cost\nWood,plane,parallel,SAH+LSPH,50\n");
    write_file(path("rays.csv"), "ox,oy,oz,dx,dy,dz\n0.5,0.25,1,0,0,-1\n");
    write_file(path("areas.json"),
               R"({"format": "raygrain-areas", "version": 1, "areas": [{"name": "a", "plane": {"center": [0, 0, 1],
                   "direction": [0, 0, -1], "half_width": 1, "half_height": 1, "depth": 2}}]})");
    write_file(path("page.html"), "<script>@RAYGRAIN_REPORT@</script>");
    ASSERT_EQ(run_program({"scene", "convert", path("quad.obj"), "-o", path("scene.json")}).exit_code, 0);
    ASSERT_EQ(run_program({"build", path("quad.obj"), "--recipe", "SAH+ALL", "-o", path("tree.rgt")}).exit_code, 0);
    fs::create_directories(path("study"));
    fs::copy_file(path("res.csv"), path("study/results.csv"));
    fs::create_directories(path("compared"));
    fs::copy_file(path("areas.json"), path("compared/compare.json"));
    fs::create_symlink("quad.obj", path("link.obj"));
    fs::create_symlink(folder_.path(), path("other"));
    fs::create_hard_link(path("res.csv"), path("hard.csv"));
  }

  std::string path(const std::string& name) const { return folder_.file(name); }

  /// Contents of all files, by name.
  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path()))
      if (entry.is_regular_file()) files[entry.path().string()] = read_file(entry.path().string());
    return files;
  }

  TemporaryFolder folder_;
};

TEST_F(SeparateFiles, AreDemandedOfEveryCommand) {
  const std::string obj = path("quad.obj"), link = path("link.obj"), res = path("res.csv");
  struct Row {
    std::vector<std::string> arguments;
    std::string message;
  };
  for (const Row& row : std::vector<Row>{
           {{"report", res, "--out", res}, "--out"},
           {{"report", res, "--out", path("./res.csv")}, "--out"},
           {{"report", res, "--out", path("other/res.csv")}, "--out"},
           {{"report", res, "--markdown", path("hard.csv")}, "--markdown"},
           {{"report", res, "--json", res}, "--json"},
           {{"report", path("study"), "--out", path("study/results.csv")}, "--out"},
           {{"report", res, "--out", path("page.html"), "--template", path("page.html")}, "--template"},
           {{"report", res, "--out", path("page.html"), "--views", path("page.html")}, "--views"},
           {{"report", res, "--out", path("new"), "--markdown", path("new")}, "--markdown"},
           {{"report", res, "--out", path("new"), "--markdown", path("other/new")}, "--markdown"},
           {{"report", res, "--out", path("new"), "--json", path("./new")}, "--json"},
           {{"view", obj, "--out", obj}, "SCENE"},
           {{"view", obj, "--out", link}, "SCENE"},
           {{"view", link, "--out", obj}, "SCENE"},
           {{"view", obj, "--areas", path("areas.json"), "--out", path("areas.json")}, "--areas"},
           {{"view", obj, "--out", path("page.html"), "--template", path("page.html")}, "--template"},
           {{"trace", obj, "--rays", path("rays.csv"), "-o", path("rays.csv")}, "--rays"},
           {{"trace", obj, "--rays", path("rays.csv"), "-o", obj}, "SCENE"},
           {{"trace", obj, "--rays", path("rays.csv"), "--tree", path("tree.rgt"), "-o", path("tree.rgt")}, "--tree"},
           {{"trace", obj, "--rays", path("rays.csv"), "-o", path("new"), "--json", path("new")}, "--json"},
           {{"explain", obj, "--rays", path("rays.csv"), "--json", path("rays.csv")}, "--json"},
           {{"scene", "convert", obj, "-o", obj}, "SCENE"},
           {{"scene", "convert", link, "-o", path("other/quad.obj")}, "SCENE"},
           {{"scene", "convert", path("scene.json"), "-o", path("scene.json")}, "SCENE"},
           {{"scene", "convert", path("scene.json"), "-o", path("scene.ply")}, "SCENE"},  // its mesh
           {{"scene", "convert", path("scene.ply"), "-o", path("scene.json")}, "SCENE"},  // writes scene.ply, too
           {{"scene", "info", obj, "--json", obj}, "SCENE"},
           {{"scene", "generate", "city", "-o", path("new.ply"), "--json", path("new.ply")}, "--json"},
           {{"build", obj, "--recipe", "SAH+ALL", "-o", obj}, "SCENE"},
           {{"build", obj, "--recipe", "PAH+ALL", "--areas", path("areas.json"), "-o", path("areas.json")}, "--areas"},
           {{"analyze", obj, "--recipe", "SAH+ALL", "--nodes", link}, "SCENE"},
           {{"analyze", obj, "--recipe", "SAH+ALL", "--tree", path("tree.rgt"), "--json", path("tree.rgt")}, "--tree"},
           {{"refit", obj, "--tree", path("tree.rgt"), "-o", path("tree.rgt")}, "--tree"},
           {{"compare", obj, "--areas", path("compared/compare.json"), "--out", path("compared")}, "--areas"},
           {{"compare", obj, "--sun", "0,0,-1", "--out", path("c"), "--json", path("c/compare.json")}, "--json"},
       }) {
    std::string command;
    for (const std::string& word : row.arguments) command += word + ' ';
    SCOPED_TRACE(command);
    const auto before = contents();
    const RunResult result = run_program(row.arguments);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_NE(result.errors.find(row.message), std::string::npos) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1);
    EXPECT_EQ(contents(), before);
  }
}

TEST_F(SeparateFiles, MayBeReplacedWhereNothingIsReadFromThem) {
  const std::string obj = path("quad.obj");
  write_file(path("old.html"), "old");
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"report", path("res.csv"), "--out", path("old.html"), "--static"},
           {"scene", "convert", obj, "-o", path("scene.json")},
           {"build", obj, "--recipe", "SAH+ALL", "-o", path("tree.rgt"), "--json", "/dev/null"},
           {"trace", obj, "--rays", path("rays.csv"), "-o", "/dev/null", "--json", "/dev/null"},
           {"compare", obj, "--sun", "0,0,-1", "--rays", "20", "--out", path("compared")}}) {
    const RunResult result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 0) << arguments[0] << ": " << result.errors;
  }
  EXPECT_NE(read_file(path("old.html")), "old");
}

}  // namespace
}  // namespace raygrain::test
