#include "base/trigonometry.h"

#include <cmath>
#include <cstddef>

namespace raygrain {

namespace {

// Taylor series in Horner form on [-pi/4, pi/4]; the first term left out is below 2^-60.
double sine_series(double x) {
  const double square = x * x;
  double sum = 1;
  for (int k = 19; k >= 3; k -= 2) sum = 1 - square / (k * (k - 1)) * sum;
  return x * sum;
}

double cosine_series(double x) {
  const double square = x * x;
  double sum = 1;
  for (int k = 18; k >= 2; k -= 2) sum = 1 - square / (k * (k - 1)) * sum;
  return sum;
}

// Taylor series on [-1/16, 1/16]; the first term left out is below 2^-59 of the sum.
double arctangent_series(double x) {
  const double square = x * x;
  double sum = 1.0 / 13;
  for (int k = 11; k >= 1; k -= 2) sum = 1.0 / k - square * sum;
  return x * sum;
}

// Of k / 8.
constexpr double kArctangents[] = {0,
                                   0x1.fd5ba9aac2f6ep-4,
                                   0x1.f5b75f92c80ddp-3,
                                   0x1.6f61941e4def1p-2,
                                   0x1.dac670561bb4fp-2,
                                   0x1.1e00babdefeb4p-1,
                                   0x1.4978fa3269ee1p-1,
                                   0x1.700a7c5784634p-1,
                                   0x1.921fb54442d18p-1};

}  // namespace

SineCosine sine_cosine(double angle) {
  // Reduction by multiples of pi/2 in three parts (Cody and Waite, "Software manual for the elementary functions",
  // 1980): the first two have enough trailing zeros that quarter * part is exact.
  constexpr double kHalfPiHigh = 0x1.921fb5p+0;
  constexpr double kHalfPiMiddle = 0x1.110b46p-26;
  constexpr double kHalfPiLow = 0x1.1a62633145c07p-54;
  const double quarter = std::floor(angle * (2 / kPi) + 0.5);
  const double reduced = ((angle - quarter * kHalfPiHigh) - quarter * kHalfPiMiddle) - quarter * kHalfPiLow;
  const double s = sine_series(reduced), c = cosine_series(reduced);
  switch (static_cast<int>(quarter - 4 * std::floor(quarter / 4))) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

double tangent(double angle) {
  const SineCosine both = sine_cosine(angle);
  return both.sine / both.cosine;
}

// The angle from the nearest eighth: tan(a - b) = (tan a - tan b) / (1 + tan a tan b).
double arctangent(double y, double x) {
  const double width = std::fabs(x), height = std::fabs(y);
  const double small = height < width ? height : width, large = height < width ? width : height;
  if (large == 0) return 0;
  const double slope = small / large;
  const double eighths = std::floor(8 * slope + 0.5), near = eighths / 8;
  const auto eighth = static_cast<size_t>(eighths);
  const double rest = eighth == 0 ? slope : (small - near * large) / (large + near * small);
  double angle = kArctangents[eighth] + arctangent_series(rest);
  if (height > width) angle = kPi / 2 - angle;
  if (x < 0) angle = kPi - angle;
  return y < 0 ? -angle : angle;
}

}  // namespace raygrain
