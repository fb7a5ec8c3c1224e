#include "base/random.h"

#include <array>

#include <gtest/gtest.h>

namespace raygrain {
namespace {

TEST(Random, GivesTheReferenceSequenceOfSplitMix64) {
  // First outputs for seed 1234567 as printed in many independent implementations of the published algorithm.
  Random random(1234567);
  const std::array<uint64_t, 5> expected{6457827717110365317u, 3203168211198807973u, 9817491932198370423u,
                                         4593380528125082431u, 16408922859458223821u};
  for (const uint64_t value : expected) EXPECT_EQ(random.next(), value);
}

TEST(Random, UniformStaysInItsRangeAndFillsIt) {
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    std::array<int, 10> counts{};
    for (int i = 0; i < 100000; ++i) {
      const double value = random.uniform();
      ASSERT_GE(value, 0);
      ASSERT_LT(value, 1);
      ++counts[static_cast<size_t>(value * 10)];
    }
    // Binomial with mean 10,000 and standard deviation 95.
    for (const int count : counts) EXPECT_NEAR(count, 10000, 5 * 95);
  }
}

TEST(Random, BelowReachesEveryValueAndNoOther) {
  Random random(3);
  std::array<int, 7> counts{};
  for (int i = 0; i < 7000; ++i) {
    const uint64_t value = random.below(7);
    ASSERT_LT(value, 7u);
    ++counts[value];
  }
  for (const int count : counts) EXPECT_NEAR(count, 1000, 5 * 29);
  EXPECT_EQ(random.below(1), 0u);
}

}  // namespace
}  // namespace raygrain
