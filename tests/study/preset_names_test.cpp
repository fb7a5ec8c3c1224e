// The built-in studies by name, and what they say where models are missing.
#include <functional>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/study.h"

#include "support/shared.h"

namespace raygrain {
namespace {

TEST(Presets, AreKnownByName) {
  EXPECT_EQ(study_presets().size(), 9u);
  for (const auto& run :
       std::vector<std::function<void()>>{[] { preset_study("papers", {}); }, [] { preset_grid("areas", {}); },
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
  for (const char* name : {"paper", "published", "corrected", "parameters", "stress"}) {
    const test::TemporaryFolder folder;
    try {
      run_study(preset_study(name, {.only = {"Wood"}}), {.folder = folder.file("out")});
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kNotFound) << error.what();
      EXPECT_NE(error.message.find("Wood: needs woods.obj"), std::string::npos) << error.message;
      EXPECT_NE(error.hint.find("--scenes"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace raygrain
