// raygrain trace with the structures that a user asks for, and its verdict about the answers.
#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "raygrain/accelerator.h"
#include "raygrain/io.h"

#include "cli/asked_rays.h"
#include "cli/bad_input.h"
#include "cli/program.h"
#include "support/shared.h"

namespace raygrain::test {
namespace {

using Json = nlohmann::json;

/// Two triangles across the sun (0, 0, 1), and room around them.
const char kScene[] =
    "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 0 0 3\nv 4 0 3\nv 0 4 3\nf 4 5 6\n"
    "v 90 0 -9\nv 91 0 -9\nv 90 1 -9\nf 7 8 9\nv 90 0 9\nv 91 0 9\nv 90 1 9\nf 10 11 12\n";

struct Traced {
  Json json;
  std::string answers;  // the file
};

class TraceOfASun : public testing::Test {
 protected:
  TraceOfASun() {
    write_file(folder_.file("scene.obj"), kScene);
    std::string rays = "ox,oy,oz,dx,dy,dz,tmin,tmax\n";
    for (int i = 0; i < 60; ++i)  // along the sun, near it, across it, and none
      rays += fmt::format("{},{},-2,{},0,inf\n", 0.11 * i, 0.3 + 0.02 * i,
                          i < 20   ? "0,0,1"
                          : i < 40 ? "0.03,0.01,1"
                          : i < 50 ? "1,0.2,0"
                                   : "0,0,0");
    write_file(folder_.file("rays.csv"), rays);
  }

  Traced trace(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"trace",  folder_.file("scene.obj"),
                                       "--rays", folder_.file("rays.csv"),
                                       "--sun",  "0,0,1",
                                       "-o",     folder_.file("hits.csv"),
                                       "--json", "-"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return {result.exit_code == 0 ? Json::parse(result.output) : Json(), read_file(folder_.file("hits.csv"))};
  }

  const TemporaryFolder folder_;
};

TEST_F(TraceOfASun, ChecksColumnsAndConesOfBothKindsOfHits) {
  const Json json = trace({"--space", "ray", "--no-coverage", "--verify"}).json;
  EXPECT_EQ(json.at("mismatches"), 0);
  ASSERT_EQ(json.at("checked").size(), 4u);
  for (const Json& row : json.at("checked")) {
    SCOPED_TRACE(row.at("question"));
    EXPECT_EQ(row.at("differences"), 0);
    EXPECT_EQ(row.at("covered"), 0);
    EXPECT_EQ(row.at("columns"), 20);
    EXPECT_EQ(row.at("cones"), 20);
    EXPECT_EQ(row.at("local_searches"), 40);
    EXPECT_GE(row.at("global_searches"), 10);
  }
  EXPECT_EQ(json.at("checked").at(1).at("question"), "closest hits together");
  EXPECT_EQ(json.at("checked").at(1).at("global_searches"), json.at("counters").at("global_searches"));
}

TEST_F(TraceOfASun, ChecksCoverageWhereItIsAsked) {
  const Json json = trace({"--space", "none", "--verify", "--any"}).json;
  EXPECT_EQ(json.at("mismatches"), 0);
  for (const Json& row : json.at("checked")) {
    const bool any = row.at("question").get<std::string>().starts_with("any");
    EXPECT_EQ(row.at("differences"), 0);
    EXPECT_EQ(row.at("local_searches"), 0);
    EXPECT_EQ(row.at("covered"), any ? 0 : 20);  // any hits go to the sun, and these come from it
  }
}

TEST_F(TraceOfASun, SaysWhichRaysHitAnything) {
  const Traced any = trace({"--any"}), nearest = trace({});
  EXPECT_EQ(any.json.at("hits"), nearest.json.at("hits"));
  std::string expected = "occluded\n";
  for (size_t at = nearest.answers.find('\n') + 1; at < nearest.answers.size(); at = nearest.answers.find('\n', at) + 1)
    expected += nearest.answers.substr(at, 3) == "inf" ? "0\n" : "1\n";
  EXPECT_EQ(any.answers, expected);
  EXPECT_EQ(std::count(expected.begin(), expected.end(), '1'), any.json.at("hits"));
}

TEST_F(TraceOfASun, RoutesAsItIsTold) {
  const auto local = [&](std::vector<std::string> more) -> int {
    return trace(std::move(more)).json.at("counters").at("local_searches");
  };
  EXPECT_EQ(local({"--no-coverage"}), 40);
  EXPECT_EQ(local({"--no-coverage", "--routing", "areas", "--space", "ray", "--frame", "shear_z"}), 40);
  EXPECT_EQ(local({"--no-coverage", "--routing", "cheapest"}), 0);  // four triangles need no trees of their own
}

TEST(TraceCommand, SaysWhereCoverageLeftTreesNoRay) {
  const TemporaryFolder folder;
  const auto text_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"trace", "procedural:city?size=3", "--set", "sun",
                                       "-o",    folder.file("hits.csv")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.output.find(" triangles, 1 area\n"), std::string::npos) << result.output;
    return result.output;
  };
  const auto is_noted = [&](const std::vector<std::string>& more, const std::string& space) {
    return text_of(more).find("No ray reached a tree in " + space +
                              " space: coverage answered 10000 of 10000 rays. Add "
                              "--no-coverage") != std::string::npos;
  };
  EXPECT_TRUE(is_noted({"--space", "ray"}, "ray"));
  EXPECT_TRUE(is_noted({"--space", "world"}, "world"));
  for (const std::vector<std::string>& more : {std::vector<std::string>{},
                                               {"--space", "none"},
                                               {"--space", "ray", "--no-coverage"},
                                               {"--space", "ray", "--quiet"}})
    EXPECT_EQ(text_of(more).find("No ray reached"), std::string::npos);
  EXPECT_NE(text_of({"--verify"}).find("\nsearches by way (a ray may take several), checked by brute force\nquestion "),
            std::string::npos);
}

TEST(TraceOptions, ThatWouldBeIgnoredAreRefused) {
  const std::vector<std::string> trace{"trace", "SCENE", "--rays", "RAYS", "-o", "OUT"};
  const auto refused = [&](std::vector<std::string> more, const std::string& expected) {
    std::vector<std::string> arguments = trace;
    arguments.insert(arguments.end(), more.begin(), more.end());
    BadInput row{fmt::format("{}", fmt::join(more, " ")), arguments, 2, expected};
    row.rays = "ox,oy,oz,dx,dy,dz\n0,0,1,0,0,-1\n";
    check(row);
  };
  const std::string no_areas = ": is about influence areas, and there are none";
  refused({"--reinsert-local"}, "--reinsert-local" + no_areas);
  refused({"--wide-measure", "VISIBLE"}, "--wide-measure" + no_areas);
  refused({"--local", "PAH+ALL"}, "--local" + no_areas);
  refused({"--space", "ray"}, "--space" + no_areas);
  refused({"--no-coverage"}, "--no-coverage" + no_areas);
  refused({"--frame", "rotation"}, "Add --space ray");
  refused({"--frame", "shear", "--space", "ray"}, "Known: rotation, shear_x");
  refused({"--routing", "best"}, "Known: cheapest, areas");
  refused({"--space", "none", "--reinsert-local"}, "--space none builds none");
  refused({"--space", "none", "--no-coverage"}, "--no-coverage: leaves areas nothing");
  refused({"--space", "none", "--traversal", "binary"}, "--space: none leaves areas nothing under --traversal binary");
  refused({"--no-coverage", "--traversal", "binary"}, "--no-coverage: changes nothing under --traversal binary");
  refused({"--space", "ray", "--traversal", "binary"}, "--space: ray needs wide trees");
  refused({"--space", "ray", "--density", "solid-angle", "--sun", "0,0,1"}, "--density: is about rays through a point");
  refused({"--routing", "cheapest", "--traversal", "binary"}, "--routing: cheapest needs wide trees");
  refused({"--tree", "SCENE", "--routing", "areas"}, "--tree: cannot be combined with --routing");
  refused({"--quality", "foo"}, "--quality: unknown quality \"foo\"");
  refused({"--wide-measure", "nope"}, "--wide-measure: unknown name \"nope\"");
  refused({"--global", "SAH+ALL@papers"}, "--global: unknown name \"papers\"");
}

TEST(TraceOptions, AboutEmptyAreasSaySo) {
  check({"areas elsewhere",
         {"trace", "SCENE", "--camera", "1000,1000,1000", "2000,2000,2000", "--rays", "RAYS", "-o", "OUT", "--space",
          "ray"},
         1,
         "no triangle lies in the influence areas. Move"});
}

TEST(TraceOptions, TreesInRaySpaceNeedMemory) {
  BadInput row{"too large in ray space",
               {"trace", "procedural:terrain?size=225", "--set", "sun", "-o", "OUT", "--space", "ray"},
               1,
               "of memory, and 0.1 GiB are left"};
  row.options.memory_left = "70";  // enough for trees in the world
  check(row);
}

/// Local trees that lack a triangle answer wrongly, and only where they are asked.
TEST(CheckAnswers, FindsEveryWrongAnswer) {
  const TemporaryFolder folder;
  write_file(folder.file("scene.obj"), kScene);
  const TriangleMesh mesh = load_mesh(folder.file("scene.obj"));
  AcceleratorOptions options;
  options.coverage.reset();
  options.routing = Routing::kAreas;
  options.membership = [](const AreaGeometry&, Vec3 a, Vec3, Vec3) { return a.z != 0; };
  const InfluenceArea sun = directional_light_area("sun", {0, 0, 1}, mesh_bounds(mesh));
  const Accelerator broken(mesh, {sun}, options);
  const Ray first{{1, 1, -2}, {0, 0, 1}, 0, kInf}, only{{1, 1, -2}, {0, 0, 1}, 0, 3};
  const Ray right{{1, 1, 2}, {0, 0, 1}, 0, kInf}, across{{-1, 1, 0}, {1, 0, 0}, 0, kInf};
  const std::vector<Ray> rays{first, only, right, across};
  const auto ignore = [](double) {};
  const cli::RayAnswers answers = cli::ask_rays(broken, rays, false, 1, ignore);
  const cli::CheckedAnswers checked = cli::check_answers(broken, rays, answers, 2, ignore);
  EXPECT_EQ(checked.wrong, 2u);
  for (const cli::CheckedQuestion& row : checked.questions)
    EXPECT_EQ(row.differences, row.question.any ? 1u : 2u) << name(row.question);

  const Accelerator sound(mesh);
  cli::RayAnswers good = cli::ask_rays(sound, rays, false, 1, ignore);
  EXPECT_EQ(cli::check_answers(sound, rays, good, 1, ignore).wrong, 0u);
  good.hits[2].u = -good.hits[2].u;
  EXPECT_EQ(cli::check_answers(sound, rays, good, 1, ignore).wrong, 1u);
  EXPECT_EQ(cli::check_answers(sound, rays, answers, 1, ignore).wrong, 2u);
}

}  // namespace
}  // namespace raygrain::test
