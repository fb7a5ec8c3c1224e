// Sine, cosine, tangent and arctangent from +, -, *, / alone, so that derived geometry has the same bits on every
// machine and library.
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

/// The angle of the point (x, y) seen from the origin, from the x axis towards y, in [-pi, pi]; 0 for the origin
/// itself. Relative error below 1e-15 for |x|, |y| <= 1e300 whose quotient does not underflow.
double arctangent(double y, double x);

}  // namespace raygrain
