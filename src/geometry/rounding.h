// From double to float, downwards and upwards.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "raygrain/vec.h"

namespace raygrain {

/// The next float below one that is neither NaN nor minus infinity. std::nextafter without its call.
inline float next_below(float x) {
  if (x == 0) return -std::numeric_limits<float>::denorm_min();
  const auto bits = std::bit_cast<uint32_t>(x);
  return std::bit_cast<float>(x > 0 ? bits - 1 : bits + 1);
}

/// The greatest float that is not above x.
inline float float_below(double x) {
  const auto rounded = static_cast<float>(x);
  return static_cast<double>(rounded) <= x ? rounded : next_below(rounded);
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
