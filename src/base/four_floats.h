// Four floats as one value: x, y, z and one to spare. Plain loops of fixed length, which compilers turn into whatever
// the machine has; results are those of the four scalar operations.
#pragma once

#include <cstddef>
#include <cstdint>

namespace raygrain {

template <class Scalar>
struct alignas(16) FourOf {
  Scalar lane[4] = {};

  constexpr Scalar operator[](int i) const { return lane[i]; }
  constexpr Scalar& operator[](int i) { return lane[i]; }
};

using FourFloats = FourOf<float>;
using FourInts = FourOf<int32_t>;

template <class Operation>
constexpr FourFloats lane_by_lane(const FourFloats& a, const FourFloats& b, Operation operation) {
  FourFloats result;
  for (size_t i = 0; i < 4; ++i) result.lane[i] = operation(a.lane[i], b.lane[i]);
  return result;
}

constexpr FourFloats operator-(const FourFloats& a, const FourFloats& b) {
  return lane_by_lane(a, b, [](float x, float y) { return x - y; });
}
constexpr FourFloats operator*(const FourFloats& a, const FourFloats& b) {
  return lane_by_lane(a, b, [](float x, float y) { return x * y; });
}
constexpr FourFloats operator*(const FourFloats& a, float s) {
  return a * FourFloats{s, s, s, s};
}
constexpr FourFloats operator-(const FourFloats& a) {
  return a * -1.0f;
}

constexpr FourFloats lesser(const FourFloats& a, const FourFloats& b) {
  return lane_by_lane(a, b, [](float x, float y) { return x < y ? x : y; });
}

/// Towards zero.
constexpr FourInts truncated(const FourFloats& a) {
  FourInts result;
  for (size_t i = 0; i < 4; ++i) result.lane[i] = static_cast<int32_t>(a.lane[i]);
  return result;
}

}  // namespace raygrain
