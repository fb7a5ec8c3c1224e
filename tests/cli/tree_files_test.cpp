// Built trees as files: written, searched, fitted to moved vertices, refused where they do not belong.
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "support/shared.h"

namespace raygrain::test {
namespace {

using Json = nlohmann::json;

class TreeFiles : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(run_program({"scene", "generate", kSmallScene, "-o", file("old.obj"), "--quiet"}).exit_code, 0);
    ASSERT_EQ(build("tree.rgt", "balanced").exit_code, 0);
    write_file(file("rays.csv"), "ox,oy,oz,dx,dy,dz\n0,90,0,0.01,-1,0.02\n5,60,3,0.2,-1,0.1\n-9,1,2,1,0,0\n");
  }

  std::string file(const std::string& name) const { return folder_.file(name); }
  RunResult build(const std::string& tree, const std::string& quality) const {
    return run_program(
        {"build", file("old.obj"), "--recipe", "SAH+ALL", "--whole", "--quality", quality, "-o", file(tree)});
  }
  RunResult refit(const std::string& scene, const std::string& tree) const {
    return run_program({"refit", file(scene), "--tree", file(tree), "-o", file("new.rgt"), "--json", "-"});
  }
  RunResult trace(const std::string& scene, const std::string& tree, const std::string& hits) const {
    return run_program(
        {"trace", file(scene), "--rays", file("rays.csv"), "--verify", "-o", file(hits), "--tree", file(tree)});
  }
  /// The scene with every vertex's y multiplied.
  void write_stretched(const std::string& name, float factor) const {
    std::istringstream in(read_file(file("old.obj")));
    std::ostringstream out;
    for (std::string line; std::getline(in, line); out << line << '\n') {
      if (!line.starts_with("v ")) continue;
      std::istringstream numbers(line.substr(2));
      float x = 0, y = 0, z = 0;
      numbers >> x >> y >> z;
      std::ostringstream vertex;
      vertex.precision(9);
      vertex << "v " << x << ' ' << factor * y + 0.01f * x << ' ' << z;
      line = vertex.str();
    }
    write_file(file(name), out.str());
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(TreeFiles, AreAnalyzedAndSearchedInPlaceOfNewTrees) {
  const RunResult built = build("again.rgt", "balanced");
  EXPECT_NE(built.output.find("build_peak_memory"), std::string::npos);
  EXPECT_EQ(read_file(file("again.rgt")), read_file(file("tree.rgt")));
  const RunResult analyzed = run_program(
      {"analyze", file("old.obj"), "--recipe", "SAH+ALL", "--whole", "--tree", file("tree.rgt"), "--json", "-"});
  ASSERT_EQ(analyzed.exit_code, 0) << analyzed.errors;
  EXPECT_GT(Json::parse(analyzed.output).at("rows").at(0).at("estimated_cost"), 1);
  for (const char* fact : {"orientations_per_node", "fallback_share", "build_seconds"})
    EXPECT_TRUE(Json::parse(analyzed.output).at("rows").at(0).at(fact).is_null()) << fact;
  for (const char* quality : {"fast", "balanced", "best"}) {
    ASSERT_EQ(build("tree.rgt", quality).exit_code, 0);
    const RunResult traced = trace("old.obj", "tree.rgt", std::string(quality) + ".csv");
    EXPECT_EQ(traced.exit_code, 0) << traced.errors;
    EXPECT_EQ(read_file(file(std::string(quality) + ".csv")), read_file(file("fast.csv")));
  }
}

/// What only the builder of a tree knew is left out, not 0.
TEST_F(TreeFiles, AreAnalyzedWithoutWhatTheBuilderKnew) {
  const auto text_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"analyze", file("old.obj"), "--recipe", "SAH+LSPH", "--whole"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result.output;
  };
  const auto lacks = [](const std::string& text, const std::string& part) {
    return text.find(part) == std::string::npos;
  };
  const std::string loaded = text_of({"--tree", file("tree.rgt"), "--nodes", file("loaded.csv")});
  EXPECT_FALSE(lacks(loaded, ", " + file("tree.rgt") + ", priced as SAH+LSPH\n")) << loaded;
  EXPECT_FALSE(lacks(loaded, "  estimated_cost ")) << loaded;
  for (const char* part : {"orientations_per_node", "fallback_share", "_seconds"}) EXPECT_TRUE(lacks(loaded, part));
  EXPECT_TRUE(read_file(file("loaded.csv")).ends_with(",,,,,,,\r\n")) << read_file(file("loaded.csv")).substr(0, 400);
  const std::string reinserted = text_of({"--reinsert"}), built = text_of({});
  for (const char* part : {"orientations_per_node", "fallback_share"}) {
    EXPECT_FALSE(lacks(built, part)) << part;
    EXPECT_TRUE(lacks(reinserted, part)) << part;
  }
  EXPECT_FALSE(lacks(reinserted, "build_seconds"));
}

TEST_F(TreeFiles, FitMovedVertices) {
  const RunResult same = refit("old.obj", "tree.rgt");
  ASSERT_EQ(same.exit_code, 0) << same.errors;
  EXPECT_EQ(Json::parse(same.output).at("ratio"), 1);
  EXPECT_EQ(read_file(file("new.rgt")), read_file(file("tree.rgt")));

  write_stretched("moved.obj", 1.1f);
  EXPECT_EQ(trace("moved.obj", "tree.rgt", "hits.csv").exit_code, 1);  // boxes do not hold what moved
  const RunResult moved = refit("moved.obj", "tree.rgt");
  ASSERT_EQ(moved.exit_code, 0) << moved.errors;
  EXPECT_FALSE(Json::parse(moved.output).at("rebuild"));
  const RunResult traced = trace("moved.obj", "new.rgt", "hits.csv");
  EXPECT_EQ(traced.exit_code, 0) << traced.errors;
}

TEST_F(TreeFiles, AreRefusedWhereTheyDoNotBelong) {
  ASSERT_EQ(build("split.rgt", "best").exit_code, 0);
  const RunResult split = refit("old.obj", "split.rgt");
  EXPECT_EQ(split.exit_code, 1);
  EXPECT_NE(split.errors.find("split"), std::string::npos) << split.errors;

  write_file(file("quad.obj"), "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
  EXPECT_EQ(refit("quad.obj", "tree.rgt").exit_code, 1);
  EXPECT_EQ(trace("quad.obj", "tree.rgt", "hits.csv").exit_code, 1);
  std::string bytes = read_file(file("tree.rgt"));
  bytes[bytes.size() / 2] ^= 1;
  write_file(file("damaged.rgt"), bytes);
  const RunResult damaged = refit("old.obj", "damaged.rgt");
  EXPECT_EQ(damaged.exit_code, 1);
  EXPECT_NE(damaged.errors.find("checksum"), std::string::npos) << damaged.errors;
  for (const char* name : {"new.rgt", "hits.csv"}) EXPECT_EQ(read_file(file(name)), "") << name;
}

}  // namespace
}  // namespace raygrain::test
