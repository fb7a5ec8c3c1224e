// Sine, cosine and tangent from +, -, *, / alone, so that derived geometry has the same bits on every machine and
// library.
#pragma once

namespace raygrain {

inline constexpr double kPi = 3.14159265358979323846;

constexpr double radians(double degrees) {
  return degrees * (kPi / 180);
}

struct SineCosine {
  double sine, cosine;
};

/// Both of an angle in radians, |angle| <= 1e6; absolute error below 1e-15 for |angle| <= 2 pi.
SineCosine sine_cosine(double angle);

/// tan(angle), |angle| < pi / 2.
double tangent(double angle);

}  // namespace raygrain
