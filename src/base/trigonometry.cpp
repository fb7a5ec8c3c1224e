#include "base/trigonometry.h"

#include <cmath>

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

}  // namespace raygrain
