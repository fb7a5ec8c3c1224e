#include "base/memory.h"

#include <cstdlib>

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

TEST_F(Memory, IsNoMoreThanTheProcessMayTake) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_DATA, &before), 0);
  rlimit small = before;
  small.rlim_cur = 1;  // less than there is already; nothing is allocated until it goes
  ASSERT_EQ(::setrlimit(RLIMIT_DATA, &small), 0);
  const uint64_t left = available_memory();
  ::setrlimit(RLIMIT_DATA, &before);
  EXPECT_EQ(left, 0u);
}

}  // namespace
}  // namespace raygrain
