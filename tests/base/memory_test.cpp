#include "base/memory.h"

#include <cstdlib>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace raygrain {
namespace {

class Memory : public testing::Test {
 protected:
  void SetUp() override { ::unsetenv("RAYGRAIN_MEMORY"); }
  void TearDown() override { ::unsetenv("RAYGRAIN_MEMORY"); }
};

TEST_F(Memory, IsSomeAndNotEndless) {
  EXPECT_GT(available_memory(), uint64_t{1} << 20);
  EXPECT_LT(available_memory(), uint64_t{1} << 50);
}

TEST_F(Memory, IsWhatTheEnvironmentSays) {
  ::setenv("RAYGRAIN_MEMORY", "100", 1);
  EXPECT_EQ(available_memory(), uint64_t{100} << 20);
  ::setenv("RAYGRAIN_MEMORY", "0", 1);
  EXPECT_EQ(available_memory(), 0u);
  for (const char* text : {"", "much", "-1", "1.5", "10G", "99999999999999999999", "18446744073709551615"}) {
    ::setenv("RAYGRAIN_MEMORY", text, 1);
    EXPECT_GT(available_memory(), uint64_t{1} << 20) << text;  // as without it
    EXPECT_LT(available_memory(), uint64_t{1} << 50) << text;
  }
}

/// Bytes of data that this process has mapped.
uint64_t mapped_data() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    uint64_t kibibytes = 0;
    if (word == "VmData:" && status >> kibibytes) return kibibytes << 10;
  }
  return 0;
}

// The limit leaves room: allocators of sanitizers do not survive without.
TEST_F(Memory, IsNoMoreThanTheProcessMayTake) {
  constexpr uint64_t kRoom = uint64_t{256} << 20;
  const uint64_t mapped = mapped_data();
  if (mapped == 0) GTEST_SKIP() << "this system does not say how much data a process has mapped";
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_DATA, &before), 0);
  rlimit small = before;
  small.rlim_cur = mapped + kRoom;
  ASSERT_EQ(::setrlimit(RLIMIT_DATA, &small), 0);
  const uint64_t left = available_memory();
  ::setrlimit(RLIMIT_DATA, &before);
  EXPECT_LE(left, kRoom);
  EXPECT_GE(left, kRoom / 2);
}

}  // namespace
}  // namespace raygrain
