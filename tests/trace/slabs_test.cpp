// Box tests never lose a point of the ray, and find little more than the box.
#include "trace/slabs.h"

#include <gtest/gtest.h>

#include "base/random.h"

namespace raygrain {
namespace {

constexpr float kMax = std::numeric_limits<float>::max();

float just_below(double x) {
  const auto rounded = static_cast<float>(x);
  return rounded <= x ? rounded : std::nextafter(rounded, -kInf);
}
float just_above(double x) {
  return -just_below(-x);
}

// A float with few mantissa bits, often zero, of any magnitude around 2^exponent.
float coarse(Random& random, int exponent) {
  const double mantissa = static_cast<double>(random.below(2049)) - 1024;
  return random.below(6) == 0 ? 0 : static_cast<float>(std::ldexp(mantissa, exponent - 10));
}

// The smallest box of floats about the exact point at t, and larger ones that have the point on a side or corner.
TEST(Slabs, HoldEveryPointOfTheRay) {
  Random random(1);
  for (int i = 0; i < 300000; ++i) {
    const int exponent = static_cast<int>(random.below(200)) - 100;
    const auto component = [&] { return coarse(random, exponent + static_cast<int>(random.below(12)) - 6); };
    Ray ray;
    for (int k = 0; k < 3; ++k) ray.origin[k] = component(), ray.direction[k] = component();
    if (!is_valid(ray)) continue;
    const double t = coarse(random, 0);  // products and sums below are exact in double
    Bounds box;
    for (int k = 0; k < 3; ++k) {
      const double point = ray.origin[k] + t * ray.direction[k];
      box.lo[k] = just_below(point);
      box.hi[k] = just_above(point);
      if (random.below(3) == 0) box.hi[k] = box.hi[k] + std::abs(component());
      if (random.below(3) == 0) box.lo[k] = box.lo[k] - std::abs(component());
    }
    const Interval inside = Slabs(ray)(box);
    ASSERT_LE(inside.entry, t) << i;
    ASSERT_GE(inside.exit, t) << i;
  }
}

TEST(Slabs, ZeroComponentsAreContainment) {
  const Bounds box{{-1, -2, -3}, {1, 2, 3}};
  const auto meets = [&](Vec3 origin, Vec3 direction) {
    const Interval inside = Slabs({origin, direction})(box);
    return inside.entry <= inside.exit;
  };
  for (const float zero : {0.0f, -0.0f}) {
    for (const float side : {-1.0f, 0.5f, 1.0f}) EXPECT_TRUE(meets({side, 2, 9}, {zero, zero, -1})) << side;
    for (const float side : {-1.0001f, 1.0001f, kMax, -kMax}) {
      EXPECT_FALSE(meets({side, 0, 9}, {zero, zero, -1})) << side;
      EXPECT_FALSE(meets({side, 0, 0}, {zero, 1, 1})) << side;
    }
  }
}

TEST(Slabs, AreTightAndClosed) {
  const Interval inside = Slabs({{-3, 0, 0}, {2, 0.5f, 0}})({{-1, -1, -1}, {1, 0.75f, 1}});
  EXPECT_NEAR(inside.entry, 1, 1e-14);
  EXPECT_NEAR(inside.exit, 1.5, 1e-14);
  const Interval point = Slabs({{-3, 0, 0}, {1, 0, 0}})({{-1, 0, 0}, {-1, 0, 0}});
  EXPECT_LE(point.entry, 2);
  EXPECT_GE(point.exit, 2);
  EXPECT_NEAR(point.exit - point.entry, 0, 1e-14);
}

TEST(Slabs, EmptyAndExtremeBoxes) {
  const auto meets = [&](const Ray& ray, const Bounds& box) {
    const Interval inside = Slabs(ray)(box);
    return inside.entry <= inside.exit;
  };
  const Vec3 directions[] = {{1, 0, 0}, {-1, 2, 0}, {0x1p-149f, kMax, -kMax}, {0, 0, -0x1p-149f}};
  for (const Vec3 direction : directions) {
    EXPECT_FALSE(meets({{0, 0, 0}, direction}, Bounds{}));
    EXPECT_TRUE(meets({{0, 0, 0}, direction}, {{-kMax, -kMax, -kMax}, {kMax, kMax, kMax}}));
    EXPECT_TRUE(meets({{kMax, kMax, kMax}, direction}, {{-kMax, -kMax, -kMax}, {kMax, kMax, kMax}}));
  }
}

}  // namespace
}  // namespace raygrain
