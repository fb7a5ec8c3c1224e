// Ctrl-C at any moment: exit code 130 and no half-written file.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include "cli/program.h"
#include "support/shared.h"

namespace raygrain::test {
namespace {

using Milliseconds = std::chrono::milliseconds;

const std::vector<std::string> kFinished{"compare.csv", "compare.json", "sun-cost.png", "sun-depth.png"};

/// Interrupts a comparison after a while; what it left must be whole files only.
void interrupt_after(Milliseconds delay, int signal) {
  SCOPED_TRACE("after " + std::to_string(delay.count()) + " ms, signal " + std::to_string(signal));
  const TemporaryFolder folder;
  const std::string out = folder.file("new/folder");
  RunningProgram program({"compare", "procedural:city?size=60", "--rays", "20000", "--out", out}, folder.file("output"),
                         folder.file("errors"));
  std::this_thread::sleep_for(delay);
  const bool running = program.is_running();
  program.send(signal);
  const int exit_code = program.wait();
  const bool before_start = exit_code == -signal;  // on a busy machine, before the program has done anything
  if (before_start) {
    EXPECT_EQ(names_in(out), std::vector<std::string>{});
  } else if (running && exit_code != 0) {
    EXPECT_EQ(exit_code, 128 + signal);
  }
  EXPECT_EQ(read_file(folder.file("errors")), "");
  // A folder that was made for nothing goes again.
  EXPECT_EQ(std::filesystem::exists(folder.file("new")), !names_in(out).empty());
  for (const std::string& name : names_in(out)) {
    EXPECT_NE(std::find(kFinished.begin(), kFinished.end(), name), kFinished.end()) << name;
    const std::string content = read_file(out + "/" + name);
    if (name.ends_with(".png")) {
      EXPECT_EQ(content.substr(content.size() - 8, 4), "IEND") << name;
    }
    if (name.ends_with(".json")) {
      EXPECT_TRUE(content.ends_with("}\n")) << name;
    }
  }
}

TEST(Interrupt, LeavesNoHalfWrittenFile) {
  for (const int delay : {100, 300, 700, 1500}) interrupt_after(Milliseconds(delay), SIGINT);
  interrupt_after(Milliseconds(200), SIGTERM);
}

TEST(Interrupt, LeavesAnEmptyFolderThatWasThere) {
  const TemporaryFolder folder;
  const std::string out = folder.file("out");
  std::filesystem::create_directory(out);
  RunningProgram program({"compare", "procedural:city?size=60", "--rays", "20000", "--out", out}, folder.file("output"),
                         folder.file("errors"));
  std::this_thread::sleep_for(Milliseconds(500));
  program.send(SIGINT);
  program.wait();
  EXPECT_TRUE(std::filesystem::exists(out));
}

TEST(Interrupt, EndsAWriteInProgressWithoutATrace) {
  const TemporaryFolder folder;
  const std::string out = folder.file("big.obj");
  RunningProgram program({"scene", "generate", "terrain", "--size", "1500", "-o", out}, folder.file("output"),
                         folder.file("errors"));
  // Interrupt as soon as the unfinished file is there, under whatever name.
  for (int i = 0; i < 3000 && program.is_running() && names_in(folder.path()).size() < 3; ++i)
    std::this_thread::sleep_for(Milliseconds(5));
  ASSERT_TRUE(program.is_running()) << "the scene is too small for this test";
  program.send(SIGINT);
  EXPECT_EQ(program.wait(), 130);
  EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{"errors", "output"}));
}

}  // namespace
}  // namespace raygrain::test
