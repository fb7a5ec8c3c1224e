// Grids: from JSON and by hand, with heuristics of one's own, exact for every ray.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "raygrain/accelerator.h"
#include "raygrain/error.h"
#include "raygrain/rays.h"
#include "raygrain/study.h"

#include "support/shared.h"

namespace raygrain {
namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

const char* const kGrid = R"({
  "format": "raygrain-study", "version": 1, "name": "mine",
  "scenes": [{"paper": "Random100"}, {"scene": "procedural:terrain?size=8", "name": "Hills"}],
  "measures": [{"name": "MINE", "face_weights": [0.1, 0.9, 0.1]}],
  "recipes": ["SAH+LSPH", "MINE+ALL@binned",
              {"recipe": "PAH+SPFH", "setting": "quality 0.1", "parameters": {"split_plane_quality_threshold": 0.1}},
              {"recipe": "PAH+ALL@binned", "name": "improved", "reinsert": 1}],
  "rays": [{"count": 100}, {"name": "angular", "spread": "angle", "count": 50}],
  "seeds": [1, 2], "repeats": 2, "global": "SAH+ALL@binned"
})";

class GridFile : public testing::Test {
 protected:
  StudyGrid load(const std::string& text) {
    const std::string path = folder_.file("grid.json");
    std::ofstream(path) << text;
    return load_study_grid(path, {});
  }
  test::TemporaryFolder folder_;
};

TEST_F(GridFile, RunsEveryCombinationOnce) {
  const StudyGrid grid = load(kGrid);
  const Study study = make_study(grid);
  EXPECT_EQ(study.tasks.size(), size_t{(8 + 1) * 4 * 2 * 2 * 2});
  const StudyTable table = run_study(study, {.folder = folder_.file("out"), .jobs = 2});
  ASSERT_EQ(table.rows.size(), study.tasks.size());
  const size_t mismatches = table.column("mismatches"), cost = table.column("real_cost_local");
  for (size_t row = 0; row < table.rows.size(); ++row) {
    EXPECT_EQ(table.number(row, mismatches), 0);
    EXPECT_GT(table.number(row, cost), 0);
    EXPECT_LE(table.number(row, table.column("pruned_cost")), table.number(row, cost));
    if (table.rows[row][table.column("setting")] == "quality 0.1") {
      EXPECT_NEAR(table.number(row, table.column("split_plane_quality_threshold")), 0.1, 1e-6);
    }
  }
}

TEST_F(GridFile, RefusesWhatItDoesNotUnderstand) {
  struct Row {
    const char *from, *to, *where;
    ErrorCode code;
  };
  for (const Row& row : std::vector<Row>{
           {"raygrain-study", "raygrain-scene", "#/format", ErrorCode::kUnsupported},
           {"\"version\": 1", "\"version\": 2", "#/version", ErrorCode::kUnsupported},
           {"\"name\": \"mine\",", "", "", ErrorCode::kMalformed},
           {"\"seeds\"", "\"seed\"", "", ErrorCode::kMalformed},
           {"Random100", "Random10", "#/scenes/0/paper", ErrorCode::kMalformed},
           {"terrain?size=8", "terrain?size=x", "#/scenes/1/scene", ErrorCode::kMalformed},
           {"procedural:terrain?size=8", "none.ply", "#/scenes/1/scene", ErrorCode::kNotFound},
           {"[0.1, 0.9, 0.1]", "[0.1, -0.9, 0.1]", "#/measures/0/face_weights", ErrorCode::kMalformed},
           {"SAH+LSPH", "SOH+LSPH", "#/recipes/0", ErrorCode::kMalformed},
           {"\"reinsert\": 1", "\"reinsert\": -1", "#/recipes/3/reinsert", ErrorCode::kMalformed},
           {"\"split_plane_quality_threshold\": 0.1", "\"quality\": 0.1", "#/recipes/2/parameters",
            ErrorCode::kMalformed},
           {"\"angle\"", "\"angles\"", "#/rays/1/spread", ErrorCode::kMalformed},
           {"\"count\": 100", "\"count\": 0", "#/rays/0/count", ErrorCode::kMalformed},
           {"\"repeats\": 2", "\"repeats\": 0", "#/repeats", ErrorCode::kMalformed},
           {"\"SAH+ALL@binned\"", "\"SAH\"", "#/global", ErrorCode::kMalformed},
           {"[0.1, 0.9, 0.1]", "[0, 0, 0]", "#/measures/0/face_weights", ErrorCode::kMalformed},
           {"\"name\": \"MINE\"", "\"name\": \"PAH\"", "#/measures/0/name", ErrorCode::kMalformed},
           {"\"name\": \"MINE\"", "\"name\": \"sampled\"", "#/measures/0/name", ErrorCode::kMalformed},
           {"\"name\": \"MINE\"", "\"name\": \"MY+OWN\"", "#/measures/0/name", ErrorCode::kMalformed},
           {"\"name\": \"MINE\"", "\"name\": \"MI\\tNE\"", "#/measures/0/name", ErrorCode::kMalformed},
           {"\"reinsert\": 1", "\"reinsert\": 7", "#/recipes/3/reinsert", ErrorCode::kMalformed},
           {"\"reinsert\": 1", "\"in_frame\": 2", "#/recipes/3/in_frame", ErrorCode::kMalformed},
           {"\"reinsert\": 1", "\"visible\": 2", "#/recipes/3/visible", ErrorCode::kMalformed},
           {"\"split_plane_quality_threshold\": 0.1", "\"split_plane_quality_threshold\": 1.5",
            "#/recipes/2/parameters/split_plane_quality_threshold", ErrorCode::kMalformed},
           {"\"split_plane_quality_threshold\": 0.1", "\"bins\": 1", "#/recipes/2/parameters/bins",
            ErrorCode::kMalformed},
           {"\"split_plane_quality_threshold\": 0.1", "\"bins\": 5000", "#/recipes/2/parameters/bins",
            ErrorCode::kMalformed},
           {"\"split_plane_quality_threshold\": 0.1", "\"max_levels\": 1000", "#/recipes/2/parameters/max_levels",
            ErrorCode::kMalformed},
           {"\"split_plane_quality_threshold\": 0.1", "\"max_leaf_cost\": -1", "#/recipes/2/parameters/max_leaf_cost",
            ErrorCode::kMalformed},
           {"\"split_plane_quality_threshold\": 0.1", "\"acceptable_ratio\": -0.5",
            "#/recipes/2/parameters/acceptable_ratio", ErrorCode::kMalformed},
           {"\"name\": \"mine\"", "\"name\": \"mi\\u0000ne\"", "", ErrorCode::kMalformed},
           {"\"name\": \"mine\"", "\"name\": \"mi\\nne\"", "#/name", ErrorCode::kMalformed},
           {"\"Hills\"", "\"Hi\\u007flls\"", "#/scenes/1/name", ErrorCode::kMalformed},
           {"\"setting\": \"quality", "\"setting\": \"\\rquality", "#/recipes/2/setting", ErrorCode::kMalformed},
           {"\"improved\"", "\"impro\\u001bved\"", "#/recipes/3/name", ErrorCode::kMalformed},
           {"\"angular\"", "\"angu\\nlar\"", "#/rays/1/name", ErrorCode::kMalformed},
           {"\"Hills\"", "\"Random100\"", "", ErrorCode::kMalformed},                 // two of one name
           {"\"improved\"", "\"MINE+ALL@binned\"", "", ErrorCode::kMalformed},        // two of one name
           {"\"MINE+ALL@binned\"", "\"DIR+ALL@binned\"", "", ErrorCode::kMalformed},  // point areas
           {"\"global\": \"SAH", "\"global\": \"PAH", "", ErrorCode::kMalformed},     // there is no area
           {"\"repeats\": 2", "\"repeats\": 1000001", "#/repeats", ErrorCode::kMalformed},
           {"\"repeats\": 2", "\"repeats\": 900000", "", ErrorCode::kLimit},
           {"}", "", "", ErrorCode::kMalformed}}) {
    SCOPED_TRACE(row.to);
    try {
      load(replaced(kGrid, row.from, row.to));
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, row.code) << error.what();
      EXPECT_NE(error.where.find(folder_.file("grid.json") + row.where), std::string::npos) << error.where;
    }
  }
}

TEST_F(GridFile, RefusesGridsThatCannotRun) {
  const StudyGrid good = load(kGrid);
  const auto refused = [&](const std::function<void(StudyGrid&)>& change) {
    StudyGrid grid = good;
    change(grid);
    try {
      run_study(make_study(grid), {.folder = folder_.file("refused")});
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kUsage) << error.what();
    }
  };
  refused([](StudyGrid& grid) { grid.scenes.clear(); });
  refused([](StudyGrid& grid) { grid.recipes.clear(); });
  refused([](StudyGrid& grid) { grid.recipes.push_back(grid.recipes[0]); });
  refused([](StudyGrid& grid) { grid.recipes[0].recipe.measure = "NONE"; });
  refused([](StudyGrid& grid) { grid.recipes[0].recipe.measure = "DIR"; });  // not for point areas
  refused([](StudyGrid& grid) { grid.rays[0].count = 0; });
  refused([](StudyGrid& grid) { grid.repeats = 0; });
  refused([](StudyGrid& grid) { grid.recipes[0].recipe.parameters.bins = 1; });
  refused([](StudyGrid& grid) { grid.recipes.back().recipe.parameters.acceptable_ratio = -1; });
  refused([](StudyGrid& grid) { grid.global.parameters.bins = 1; });
  refused([](StudyGrid& grid) { grid.recipes[0].setting = "two\nlines"; });
  refused([](StudyGrid& grid) { grid.rays[0].name = "\x1b[2J"; });
  refused([](StudyGrid& grid) { grid.registry.measures.push_back(grid.registry.measures[1]); });
}

/// What decides the numbers may be changed between a stop and the next run, in the file alone.
TEST_F(GridFile, ResumesTheSameFileAlone) {
  const std::string out = folder_.file("out");
  StudyRunOptions options{.folder = out};
  options.progress = [](const std::string&, double done) { return done < 0.3; };
  EXPECT_THROW(run_study(make_study(load(kGrid)), options), Error);
  for (const auto& [from, to] : std::vector<std::pair<const char*, const char*>>{
           {"[0.1, 0.9, 0.1]", "[0.1, 0.8, 0.1]"},
           {"\"split_plane_quality_threshold\": 0.1", "\"split_plane_quality_threshold\": 0.2"},
           {"terrain?size=8", "terrain?size=9"},
           {"\"count\": 100", "\"count\": 200"},
           {"SAH+ALL@binned\"\n", "SAH+ALL\"\n"}}) {
    try {
      run_study(make_study(load(replaced(kGrid, from, to))), {.folder = out});
      ADD_FAILURE() << to;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kUsage);
      EXPECT_NE(error.message.find("unfinished run"), std::string::npos) << error.message;
      EXPECT_FALSE(error.hint.empty());
    }
  }
  EXPECT_EQ(run_study(make_study(load(kGrid)), {.folder = out, .jobs = 2}).rows.size(),
            size_t{(8 + 1) * 4 * 2 * 2 * 2});
}

/// Rows of other rules than the contract's: everything that StudyRules replaces is asked.
TEST(Grid, TakesRulesOfOnesOwn) {
  StudyGrid grid = preset_grid("paper", {.only = {"Random1000"}, .rays = 100});
  grid.recipes = {{"SAH+LSPH", "", parse_recipe("SAH+LSPH", grid.registry)}};
  const auto run = [](const StudyGrid& what) {
    const test::TemporaryFolder folder;
    return run_study(make_study(what), {.folder = folder.path()});
  };
  const StudyTable plain = run(grid);
  const auto column = [](const StudyTable& table, const char* name) { return table.number(0, table.column(name)); };

  StudyGrid same = grid;  // the defaults, said aloud
  same.rules.area = [](const StudyScene&, const StudyArea& area, const StudyRecipe&) { return area.area; };
  same.rules.global_tree = [&](const TriangleMesh& mesh) {
    return build_global_tree(mesh, grid.global, grid.registry);
  };
  same.rules.local_tree = [&](const TriangleMesh& mesh, const InfluenceArea& area, const StudyRecipe& recipe) {
    return build_local_tree(mesh, area, recipe.recipe, grid.registry);
  };
  same.rules.rays = [](const StudyScene&, const StudyArea& area, const StudyRecipe&, const StudyRays& rays,
                       uint64_t seed) { return cast_rays(AreaRays{.area = area.area}, rays.count, seed); };
  same.rules.serves = [](const InfluenceArea& area) {
    return [geometry = AreaGeometry(area)](const Ray& ray) { return geometry.serves(ray); };
  };
  const StudyTable again = run(same);
  for (size_t row = 0; row < plain.rows.size(); ++row)
    for (size_t i = 0; i < grid_columns().size(); ++i)
      if (grid_columns()[i].deterministic) {
        EXPECT_EQ(again.rows[row][4 + i], plain.rows[row][4 + i]) << grid_columns()[i].name;
      }

  StudyGrid changed = grid;
  changed.rules.serves = [](const InfluenceArea&) { return [](const Ray&) { return false; }; };
  EXPECT_EQ(column(run(changed), "served_rays"), 0);
  changed = grid;
  changed.rules.accepts = [](const InfluenceArea&, const Ray&, const Hit&) { return false; };
  EXPECT_EQ(column(run(changed), "local_hit_ratio"), 0);
  changed = grid;
  changed.rules.rays = [](auto&&...) { return std::vector<Ray>(7, Ray{{5, 5, -4}, {0, 0, 1}}); };
  EXPECT_EQ(column(run(changed), "rays"), 7);
  changed = grid;
  changed.rules.area = [](const StudyScene&, const StudyArea& area, const StudyRecipe&) {
    InfluenceArea half = area.area;
    if (auto* plane = std::get_if<PlaneArea>(&half.shape)) plane->half_width /= 2;
    return half;
  };
  EXPECT_LT(column(run(changed), "triangles"), column(plain, "triangles"));
  changed = grid;
  changed.rules.global_tree = [&](const TriangleMesh& mesh) {
    return build_global_tree(mesh, parse_recipe("SAH+ALL@sweep", grid.registry), grid.registry);
  };
  EXPECT_LT(column(run(changed), "global_cost"), column(plain, "global_cost"));
}

/// A lambda is enough, and a measure that equals surface area gives surface area's rows.
TEST(Grid, TakesAMeasureOfOnesOwn) {
  StudyGrid grid = preset_grid("paper", {.only = {"Random100"}, .rays = 200});
  grid.registry.measures.push_back({"MINE", "half of the surface", false, false, [](const HeuristicInput&) {
                                      return RayMeasure([](const Bounds& box) {
                                        const Vec3 e = extent(box);
                                        return e.x * e.y + e.y * e.z + e.z * e.x;
                                      });
                                    }});
  grid.recipes = {{"SAH+LSPH", "", parse_recipe("SAH+LSPH", grid.registry)},
                  {"MINE+LSPH", "", parse_recipe("MINE+LSPH", grid.registry)}};
  const test::TemporaryFolder folder;
  const StudyTable table = run_study(make_study(grid), {.folder = folder.path()});
  ASSERT_EQ(table.rows.size(), 16u);
  const size_t combo = table.column("combo"), cost = table.column("real_cost_local");
  for (size_t row = 0; row < 16; row += 2) {
    EXPECT_EQ(table.rows[row][combo], "MINE+LSPH");
    EXPECT_EQ(table.rows[row + 1][combo], "SAH+LSPH");
    EXPECT_EQ(table.number(row, cost), table.number(row + 1, cost));
  }
  EXPECT_FALSE(study_summary(table).empty());
}

/// PAH predicts within 2 % once rays are drawn as it assumes.
TEST(Grid, PredictionsOfProjectedAreaHold) {
  StudyGrid grid = preset_grid("paper", {.only = {"Random1000"}, .rays = 20000});
  std::erase_if(grid.recipes, [](const StudyRecipe& recipe) { return recipe.combo != "PAH+SPFH"; });
  const test::TemporaryFolder folder;
  const StudyTable table = run_study(make_study(grid), {.folder = folder.path(), .jobs = 2});
  for (const char* kind : {"plane", "point"}) {
    EXPECT_LT(prediction_error(table, "estimated_pah", kind), 0.02) << kind;
    EXPECT_GT(prediction_error(table, "estimated_sah", kind), 0.1) << kind;
  }
  EXPECT_TRUE(std::isnan(prediction_error(table, "estimated_pah", "plane", "SAH+LSPH")));
}

}  // namespace
}  // namespace raygrain
