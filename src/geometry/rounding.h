// From double to float, downwards and upwards.
#pragma once

#include <cmath>

#include "raygrain/vec.h"

namespace raygrain {

/// The greatest float that is not above x.
inline float float_below(double x) {
  const auto rounded = static_cast<float>(x);
  return static_cast<double>(rounded) <= x ? rounded : std::nextafter(rounded, -kInf);
}

/// The least float that is not below x.
inline float float_above(double x) {
  return -float_below(-x);
}

/// A float that is not above (below) x, and within two floats of it; without branches, for rays.
inline float loosely_below(double x) {
  return static_cast<float>(x - (std::abs(x) * 0x1p-23 + 0x1p-148));
}
inline float loosely_above(double x) {
  return static_cast<float>(x + (std::abs(x) * 0x1p-23 + 0x1p-148));
}

}  // namespace raygrain
