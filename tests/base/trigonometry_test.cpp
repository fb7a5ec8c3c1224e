#include "base/trigonometry.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/random.h"

namespace raygrain {
namespace {

TEST(Trigonometry, AgreesWithTheLibraryToItsStatedError) {
  Random random(1);
  for (int i = 0; i < 200000; ++i) {
    const double angle = random.uniform(-2 * kPi, 2 * kPi);
    const SineCosine both = sine_cosine(angle);
    ASSERT_NEAR(both.sine, std::sin(angle), 1e-15) << angle;
    ASSERT_NEAR(both.cosine, std::cos(angle), 1e-15) << angle;
  }
}

TEST(Trigonometry, StaysAccurateForLargeAngles) {
  Random random(2);
  for (int i = 0; i < 100000; ++i) {
    const double angle = random.uniform(-1e6, 1e6);
    const SineCosine both = sine_cosine(angle);
    ASSERT_NEAR(both.sine, std::sin(angle), 1e-13) << angle;
    ASSERT_NEAR(both.cosine, std::cos(angle), 1e-13) << angle;
  }
}

TEST(Trigonometry, TangentHasSmallRelativeError) {
  Random random(3);
  for (int i = 0; i < 100000; ++i) {
    const double angle = random.uniform(-1.57, 1.57);
    const double expected = std::tan(angle);
    ASSERT_NEAR(tangent(angle), expected, 1e-12 * std::abs(expected) + 1e-18) << angle;
  }
}

TEST(Trigonometry, IsExactAtZeroAndOddOrEven) {
  EXPECT_EQ(sine_cosine(0).sine, 0);
  EXPECT_EQ(sine_cosine(0).cosine, 1);
  for (const double angle : {0.1, 0.7, 1.2, 2.0}) {
    EXPECT_EQ(sine_cosine(-angle).sine, -sine_cosine(angle).sine);
    EXPECT_EQ(sine_cosine(-angle).cosine, sine_cosine(angle).cosine);
  }
}

}  // namespace
}  // namespace raygrain
