// The measure that knows what rays see, as the commands use it: of a building whose inside no ray gets to.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "raygrain/io.h"

#include "cli/program.h"
#include "support/full_building.h"
#include "support/shared.h"

namespace raygrain::test {
namespace {

using Json = nlohmann::json;

class VisibilityOfABuilding : public testing::Test {
 protected:
  VisibilityOfABuilding() {
    TriangleMesh mesh = full_building(3000, 1);
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{50, 150, 50}, {51, 150, 50}, {50, 150, 51}});  // room above the roof
    mesh.triangles.push_back({first, first + 1, first + 2});
    save_mesh(mesh, scene_);
  }

  /// Of a command about the scene and its sun.
  Json json_of(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin() + 1, scene_);
    arguments.insert(arguments.end(), {"--sun", "0,-1,0", "--json", "-"});
    const RunResult result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result.exit_code == 0 ? Json::parse(result.output) : Json();
  }

  const TemporaryFolder folder_;
  const std::string scene_ = folder_.file("building.ply");
};

TEST_F(VisibilityOfABuilding, CostsItsRaysLess) {
  const auto cost_of = [&](std::vector<std::string> arguments) {
    return json_of(std::move(arguments)).at("rows").at(0).at("pruned_cost").get<double>();
  };
  const double plain = cost_of({"analyze", "--recipe", "PAH+ALL@binned", "--rays", "1000"});
  const double visible = cost_of({"analyze", "--recipe", "VISIBLE+ALL@binned", "--rays", "1000"});
  EXPECT_LT(visible, 0.95 * plain);
  EXPECT_LE(cost_of({"analyze", "--recipe", "VISIBLE+ALL@binned", "--rays", "1000", "--reinsert"}), visible);
  const Json rows = json_of({"compare", "--recipes", "PAH+ALL@binned,VISIBLE+ALL@binned", "--rays", "1000"}).at("rows");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_LT(rows.at(1).at("pruned_cost").get<double>(), 0.95 * rows.at(0).at("pruned_cost").get<double>());
}

TEST_F(VisibilityOfABuilding, GivesAnotherTree) {
  const auto tree_of = [&](const char* recipe) {
    const std::string file = folder_.file("tree.json");
    json_of({"build", "--recipe", recipe, "-o", file});
    return Json::parse(read_file(file)).at("nodes");
  };
  EXPECT_NE(tree_of("VISIBLE+ALL@binned"), tree_of("PAH+ALL@binned"));
}

TEST(Visibility, IsToldWhereNoSampleHitsAnything) {
  const TemporaryFolder folder;
  write_file(folder.file("walls.obj"),  // seen edge-on from above
             "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 0 0 3\nv 4 0 3\nv 0 4 3\nf 4 5 6\n");
  const auto output_of = [&](const char* sun) {
    return run_program({"build", folder.file("walls.obj"), "--recipe", "VISIBLE+ALL", "--sun", sun, "-o",
                        folder.file("tree.json")})
        .output;
  };
  EXPECT_NE(output_of("0,-1,0").find("No sample ray hits anything"), std::string::npos);
  EXPECT_EQ(output_of("0,-1,1").find("No sample ray"), std::string::npos);
}

TEST_F(VisibilityOfABuilding, SparesTracedRaysWork) {
  std::string rays = "ox,oy,oz,dx,dy,dz\n";  // not quite along the sun, or its coverage answers them
  for (int x = 2; x < 100; x += 5)
    for (int z = 3; z < 100; z += 5) rays += std::to_string(x) + ",140," + std::to_string(z) + ",0.03,-1,0.01\n";
  write_file(folder_.file("rays.csv"), rays);
  const auto work_of = [&](std::vector<std::string> options) {
    std::vector<std::string> arguments{"trace",   "--rays", folder_.file("rays.csv"), "-o", folder_.file("hits.csv"),
                                       "--verify"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Json json = json_of(arguments);
    EXPECT_EQ(json.at("mismatches"), 0);
    EXPECT_EQ(json.at("counters").at("local_searches"), 400);
    const Json& local = json.at("counters").at("local");
    return local.at("inner_hits").get<uint64_t>() + local.at("leaf_triangles").get<uint64_t>();
  };
  const uint64_t plain = work_of({"--local", "PAH+ALL@binned"}), split = work_of({"--local", "VISIBLE+ALL@binned"});
  EXPECT_LT(split, plain);
  EXPECT_NE(work_of({"--local", "VISIBLE+ALL@binned", "--reinsert-local"}), split);
  EXPECT_NE(work_of({"--local", "PAH+ALL@binned", "--wide-measure", "VISIBLE"}), plain);
}

TEST_F(VisibilityOfABuilding, UnknownMeasuresOfWideFormsAreRefused) {
  const RunResult result = run_program({"trace", scene_, "--set", "none", "-o", folder_.file("hits.csv"), "--sun",
                                        "0,-1,0", "--wide-measure", "VISBLE"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("Did you mean VISIBLE?"), std::string::npos) << result.errors;
}

}  // namespace
}  // namespace raygrain::test
