#include "study/paper_experiments.h"

#include <map>

#include <gtest/gtest.h>

#include "raygrain/compare.h"
#include "raygrain/io.h"

#include "support/shared.h"

namespace raygrain {
namespace {

TEST(PaperExperiments, SixtyFourValidAreas) {
  std::map<std::string_view, int> planes, points;
  for (const PaperExperiment& experiment : paper_experiments()) {
    (experiment.is_plane() ? planes : points)[experiment.scene]++;
    validate(InfluenceArea{std::string(experiment.variant), experiment.shape}, std::string(experiment.scene));
  }
  EXPECT_EQ(paper_experiments().size(), 64u);
  EXPECT_EQ(planes.size(), 8u);
  for (const auto& [scene, count] : planes) {
    EXPECT_EQ(count, 4) << scene;
    EXPECT_EQ(points[scene], 4) << scene;
  }
}

/// What the paper missed: PAH pays once every node may try all three axes.
class PlaneParallel : public testing::TestWithParam<std::string_view> {};

std::optional<Scene> load(const PaperExperiment& experiment) {
  const std::string source(experiment.source);
  if (source.starts_with("procedural:")) return generate_scene(parse_procedural(source));
  const std::optional<std::string> path = test::shared_scene(source);
  if (!path) return std::nullopt;
  Scene scene;
  scene.mesh = load_mesh(*path);
  return scene;
}

TEST_P(PlaneParallel, ProjectedAreaBeatsSurfaceArea) {
  const auto all = paper_experiments();
  const auto experiment = std::find_if(all.begin(), all.end(), [](const PaperExperiment& e) {
    return e.scene == GetParam() && e.is_plane() && e.variant == "parallel";
  });
  ASSERT_NE(experiment, all.end());
  std::optional<Scene> scene = load(*experiment);
  if (!scene) GTEST_SKIP() << "needs ../shared/scenes";
  scene->areas = {InfluenceArea{"parallel", experiment->shape}};
  CompareOptions options;
  options.rays = 1000;
  options.recipes = {parse_recipe("SAH+ALL", options.registry), parse_recipe("PAH+ALL", options.registry)};
  const Comparison result = compare(*scene, options);
  const double sah = result.rows[0].values[FieldId::kRealCost], pah = result.rows[1].values[FieldId::kRealCost];
  RecordProperty("sah", std::to_string(sah));
  RecordProperty("pah", std::to_string(pah));
  std::cout << GetParam() << ": SAH+ALL " << sah << ", PAH+ALL " << pah << ", ratio " << pah / sah << "\n";
  EXPECT_LT(pah, sah);
  EXPECT_EQ(result.rows[0].values[FieldId::kMismatches], 0);
  EXPECT_EQ(result.rows[1].values[FieldId::kMismatches], 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, PlaneParallel,
                         testing::Values("Wood", "Cottage", "CottageWalls", "Suzanne", "Random1000"),
                         [](const auto& scene) { return std::string(scene.param); });

}  // namespace
}  // namespace raygrain
