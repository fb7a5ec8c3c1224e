// raygrain verify: its verdict, its JSON, its exit code, and scenes that it is given.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "support/shared.h"

namespace raygrain::test {
namespace {

const std::string kSavedFailure =
    (source_folder() / "tests/verify/scenes/parts-of-a-triangle-in-ray-space.json").string();

nlohmann::json json_of(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "verify");
  arguments.insert(arguments.end(), {"--rays", "30000", "--seed", "3", "--json", "-"});
  const RunResult run = run_program(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.output << run.errors;
  return nlohmann::json::parse(run.output);
}

TEST(VerifyCommand, SaysWhatItAsked) {
  const TemporaryFolder folder;
  const RunResult run = run_program({"verify", "--rays", "20000", "--out", folder.file("failures")});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(run.output.find("verified: "), 0u) << run.output;
  EXPECT_NE(run.output.find(" comparisons, "), std::string::npos) << run.output;
  EXPECT_TRUE(run.output.ends_with(" million rays/s)\n")) << run.output;
  EXPECT_TRUE(names_in(folder.path()).empty());  // no folder without failures
}

TEST(VerifyCommand, NeedsAFolderThatItWasGivenAndForFailures) {
  RunOptions nowhere;
  nowhere.folder = "/proc";  // where no folder can be made
  EXPECT_EQ(run_program({"verify", "--rays", "10"}, nowhere).exit_code, 0);
  const RunResult given = run_program({"verify", "--rays", "10", "--out", "failures"}, nowhere);
  EXPECT_EQ(given.exit_code, 1);
  EXPECT_NE(given.errors.find("failures: cannot create the folder"), std::string::npos) << given.errors;
  EXPECT_NE(given.errors.find("--out DIR"), std::string::npos) << given.errors;
}

TEST(VerifyCommand, IsTheSameForASeedOnAnyNumberOfThreads) {
  nlohmann::json one = json_of({"--threads", "1"}), two = json_of({"--threads", "2"});
  EXPECT_GE(one["rays"].get<uint64_t>(), 30000u);
  EXPECT_EQ(one["differences"], 0);
  EXPECT_EQ(one["leaks"], 0);
  EXPECT_EQ(one["failures"], nlohmann::json::array());
  for (nlohmann::json* report : {&one, &two}) {
    report->erase("seconds");
    report->erase("environment");
  }
  EXPECT_EQ(one, two);
}

TEST(VerifyCommand, TakesScenes) {
  const nlohmann::json report = json_of({kSavedFailure, kSmallScene});
  EXPECT_GT(report["scenes"].get<int>(), 1);
  const RunResult alone = run_program({"verify", kSavedFailure, "--rays", "1"});
  EXPECT_EQ(alone.exit_code, 0) << alone.errors;
  EXPECT_NE(alone.output.find("(1 scenes, "), std::string::npos) << alone.output;
}

TEST(VerifyCommand, RefusesWhatItCannotMean) {
  EXPECT_EQ(run_program({"verify", "--rays", "0"}).exit_code, 2);
  EXPECT_EQ(run_program({"verify", "--minutes", "0"}).exit_code, 2);
  EXPECT_EQ(run_program({"verify", "--minutes", "soon"}).exit_code, 2);
  const RunResult missing = run_program({"verify", "no-such-scene.obj"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.errors.find("no-such-scene.obj"), std::string::npos) << missing.errors;
}

}  // namespace
}  // namespace raygrain::test
