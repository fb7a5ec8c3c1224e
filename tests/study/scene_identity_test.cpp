// Which model a run was of: its bytes, not the spelling of its folder.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/study.h"

#include "support/shared.h"

namespace raygrain {
namespace {

constexpr const char* kModel = "v 0 0 0\nv 4 0 1\nv 0 4 1\nv 1 1 4\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n";
constexpr const char* kOther = "v 0 0 0\nv 4 0 1\nv 0 4 1\nv 1 1 5\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n";

class SceneIdentity : public testing::Test {
 protected:
  /// A folder of scenes with one model, as the paper's Suzanne.
  std::string scenes(const std::string& name, const char* model) {
    std::filesystem::create_directories(folder_.file(name));
    std::ofstream(folder_.file(name) + "/suzanne.obj") << model;
    return folder_.file(name);
  }

  static bool goes_on(const Study& study, const std::string& out) {
    try {
      run_study(study, {.folder = out});
      return true;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kUsage) << error.what();
      return false;
    }
  }

  const test::TemporaryFolder folder_;
};

TEST_F(SceneIdentity, IsOfTheFilesBytes) {
  const std::string one = scenes("one", kModel), same = scenes("same", kModel), other = scenes("other", kOther);
  for (const char* name : {"paper", "memory", "stress"}) {
    const auto study = [&](const std::string& from) {
      return preset_study(name, {.scenes = from, .only = {"Suzanne"}, .rays = 20});
    };
    const std::string out = folder_.file(name);
    ASSERT_TRUE(goes_on(study(one), out)) << name;
    EXPECT_TRUE(goes_on(study(same), out)) << name;
    EXPECT_TRUE(goes_on(study(one + "/."), out)) << name;
    EXPECT_FALSE(goes_on(study(other), out)) << name;
  }
}

TEST_F(SceneIdentity, OfAreasIsOfSponzasFile) {
  const auto identity = [&](const std::string& name, const char* bytes) {
    std::ofstream(scenes(name, kModel) + "/sponza.ply") << bytes;
    return preset_study("areas", {.scenes = folder_.file(name)}).identity;
  };
  const std::string one = identity("one", "1");
  EXPECT_EQ(identity("same", "1"), one);
  EXPECT_NE(identity("other", "2"), one);
}

TEST_F(SceneIdentity, OfAGridIsOfItsModels) {
  const std::string grid = folder_.file("grid.json"), out = folder_.file("out");
  std::ofstream(grid) << R"({"format": "raygrain-study", "version": 1, "name": "mine",
    "scenes": [{"paper": "Suzanne"}, {"scene": "suzanne.obj", "name": "Mine", "areas": [
      {"name": "sun", "sun": {"direction": [0.3, -0.8, 0.4]}}]}],
    "recipes": ["SAH+ALL@binned"], "rays": [{"count": 20}]})";
  const auto study = [&](const std::string& from) { return make_study(load_study_grid(grid, {.scenes = from})); };
  const std::string one = scenes("one", kModel);
  ASSERT_TRUE(goes_on(study(one), out));
  EXPECT_TRUE(goes_on(study(one + "/../one"), out));
  EXPECT_TRUE(goes_on(study(scenes("same", kModel)), out));
  EXPECT_FALSE(goes_on(study(scenes("other", kOther)), out));
}

}  // namespace
}  // namespace raygrain
