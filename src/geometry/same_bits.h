// Hits compared bit by bit, so that zeros of either sign and NaN are told apart.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "raygrain/ray.h"

namespace raygrain {

/// t, u, v and id.
inline bool same_bits(const Hit& a, const Hit& b) {
  using Bits = std::array<uint32_t, 4>;
  static_assert(sizeof(Hit) == sizeof(Bits), "padding would be compared");
  return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

}  // namespace raygrain
