// The configurations against a machine-readable list of them, where one lies beside the optional scenes.
#include <fstream>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "study/paper_experiments.h"
#include "support/shared.h"

namespace raygrain {
namespace {

using Json = nlohmann::json;

Vec3 vector_of(const Json& numbers) {
  return {numbers.at(0).get<float>(), numbers.at(1).get<float>(), numbers.at(2).get<float>()};
}

void expect_equal(const PlaneArea& area, const Json& test) {
  EXPECT_EQ(area.center, vector_of(test.at("point")));
  EXPECT_EQ(area.direction, vector_of(test.at("normal")));
  EXPECT_EQ(area.half_width, test.at("half_width").get<float>());
  EXPECT_EQ(area.half_height, test.at("half_height").get<float>());
  EXPECT_EQ(area.depth, test.at("forward_size").get<float>());
}

void expect_equal(const PointArea& area, const Json& test) {
  EXPECT_EQ(area.eye, vector_of(test.at("eye")));
  EXPECT_EQ(area.forward, vector_of(test.at("direction")));
  EXPECT_EQ(area.fov_x, test.at("fov_x").get<float>());
  EXPECT_EQ(area.fov_y, test.at("fov_y").get<float>());
  EXPECT_EQ(area.near_z, test.at("near").get<float>());
  EXPECT_EQ(area.far_z, test.at("far").get<float>());
}

TEST(PaperExperiments, EqualTheirSource) {
  const auto scene = test::shared_scene("../reference/experiments.json");
  if (!scene) GTEST_SKIP() << "needs ../shared/reference/experiments.json";
  const Json source = Json::parse(std::ifstream(*scene));
  std::map<std::string, Json> tests;  // by scene, kind and variant
  for (const auto& [name, entry] : source.at("scenes").items())
    for (const Json& test : entry.at("tests"))
      tests[name + " " + test.at("kind").get<std::string>() + " " + test.at("variant").get<std::string>()] = test;
  ASSERT_EQ(tests.size(), paper_experiments().size());
  for (const PaperExperiment& experiment : paper_experiments()) {
    const std::string key = std::string(experiment.scene) + (experiment.is_plane() ? " plane " : " point ") +
                            std::string(experiment.variant);
    SCOPED_TRACE(key);
    ASSERT_TRUE(tests.contains(key));
    EXPECT_EQ(experiment.scale, source.at("scenes").at(std::string(experiment.scene)).at("scale").get<float>());
    std::visit([&](const auto& area) { expect_equal(area, tests.at(key)); }, experiment.shape);
  }
}

}  // namespace
}  // namespace raygrain
