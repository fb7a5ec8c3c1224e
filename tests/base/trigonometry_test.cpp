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

TEST(Trigonometry, ArctangentHasSmallRelativeError) {
  Random random(4);
  for (int i = 0; i < 100000; ++i) {
    const double x = random.uniform(-1, 1) * std::pow(10.0, random.uniform(-9, 9)), y = random.uniform(-1, 1);
    const double expected = std::atan2(y, x);
    ASSERT_NEAR(arctangent(y, x), expected, 1e-15 * std::abs(expected)) << y << ' ' << x;
  }
}

TEST(Trigonometry, ArctangentKnowsTheAxes) {
  EXPECT_EQ(arctangent(0, 0), 0);
  EXPECT_EQ(arctangent(0, 3), 0);
  EXPECT_EQ(arctangent(0, -3), kPi);
  EXPECT_EQ(arctangent(2, 0), kPi / 2);
  EXPECT_EQ(arctangent(-2, 0), -kPi / 2);
  EXPECT_EQ(arctangent(1e300, 1e300), kPi / 4);
  EXPECT_EQ(arctangent(1e-300, 1), 1e-300);
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
