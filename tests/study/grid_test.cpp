// Grids: from JSON and by hand, with heuristics of one's own, exact for every ray.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "raygrain/error.h"
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
  for (const Row& row :
       std::vector<Row>{{"raygrain-study", "raygrain-scene", "#/format", ErrorCode::kUnsupported},
                        {"\"version\": 1", "\"version\": 2", "#/version", ErrorCode::kUnsupported},
                        {"\"name\": \"mine\",", "", "", ErrorCode::kMalformed},
                        {"\"seeds\"", "\"seed\"", "", ErrorCode::kMalformed},
                        {"Random100", "Random10", "#/scenes/0/paper", ErrorCode::kUsage},
                        {"terrain?size=8", "terrain?size=x", "#/scenes/1/scene", ErrorCode::kUsage},
                        {"procedural:terrain?size=8", "none.ply", "#/scenes/1/scene", ErrorCode::kNotFound},
                        {"[0.1, 0.9, 0.1]", "[0.1, -0.9, 0.1]", "#/measures/0/face_weights", ErrorCode::kMalformed},
                        {"SAH+LSPH", "SOH+LSPH", "#/recipes/0", ErrorCode::kUsage},
                        {"\"reinsert\": 1", "\"reinsert\": -1", "#/recipes/3/reinsert", ErrorCode::kMalformed},
                        {"\"split_plane_quality_threshold\": 0.1", "\"quality\": 0.1", "#/recipes/2/parameters",
                         ErrorCode::kMalformed},
                        {"\"angle\"", "\"angles\"", "#/rays/1/spread", ErrorCode::kMalformed},
                        {"\"count\": 100", "\"count\": 0", "#/rays/0/count", ErrorCode::kMalformed},
                        {"\"repeats\": 2", "\"repeats\": 0", "#/repeats", ErrorCode::kMalformed},
                        {"\"SAH+ALL@binned\"", "\"SAH\"", "#/global", ErrorCode::kUsage},
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

TEST(Presets, AreKnownByName) {
  EXPECT_EQ(study_presets().size(), 8u);
  for (const auto& run :
       std::vector<std::function<void()>>{[] { preset_study("papers", {}); }, [] { preset_grid("published", {}); },
                                          [] { preset_study("paper", {.only = {"Woods"}}); }}) {
    try {
      run();
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kUsage);
      EXPECT_FALSE(error.hint.empty());
    }
  }
}

TEST(Presets, SayWhatIsMissing) {
  const Study study = preset_study("paper", {});
  EXPECT_EQ(study.missing.size(), 6u);
  EXPECT_EQ(study.tasks.size(), 2u * 8 * 4);
  EXPECT_EQ(preset_study("paper", {.scenes = "/nowhere"}).missing.size(), 6u);
}

}  // namespace
}  // namespace raygrain
