// Values from fuzzed bytes; zeros when they run out.
#pragma once

#include <bit>
#include <cstddef>

#include "raygrain/vec.h"

#include "targets.h"

namespace raygrain::fuzz {

class Reader {
 public:
  explicit Reader(Bytes bytes) : rest_(bytes) {}

  bool empty() const { return rest_.empty(); }
  uint8_t byte() {
    if (rest_.empty()) return 0;
    const uint8_t value = rest_.front();
    rest_ = rest_.subspan(1);
    return value;
  }
  uint32_t word() {
    uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value |= uint32_t{byte()} << (8 * i);
    return value;
  }
  bool flag() { return byte() & 1; }
  /// In [least, most].
  uint32_t whole(uint32_t least, uint32_t most) { return least + word() % (most - least + 1); }
  /// Mostly a small multiple of 1/8, so that values coincide; else any bits.
  float any() {
    const uint8_t kind = byte();
    if (kind < 200) return (static_cast<float>(kind) - 100) / 8;
    if (kind < 220) return std::nextafter((static_cast<float>(byte()) - 128) / 8, kind < 210 ? kInf : -kInf);
    return std::bit_cast<float>(word());
  }
  float finite() {
    const float value = any();
    return std::isfinite(value) ? value : 0;
  }
  Vec3 any_point() {
    const float x = any(), y = any(), z = any();
    return {x, y, z};
  }
  Vec3 finite_point() {
    const float x = finite(), y = finite(), z = finite();
    return {x, y, z};
  }

 private:
  Bytes rest_;
};

}  // namespace raygrain::fuzz
