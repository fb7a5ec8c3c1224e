// Primitives as the fast builders hold them: box, id and key side by side, so that one pass reads memory once.
//
// Loops over lanes have fixed lengths and touch nothing else: compilers turn each into one or two vector instructions
// of whatever machine they compile for. Results are those of the scalar operations.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "raygrain/bounds.h"

namespace raygrain::builder {

/// Not initialised: a value for results that are written whole.
struct alignas(16) EightFloats {
  float at[8];
};

struct alignas(16) FourFloats {
  float at[4];
};

// Tells GCC that lanes do not overlap, or it would not dare, and that it must not unroll the loop before it makes
// vectors of it; Clang sees both.
#ifdef __clang__
#define RAYGRAIN_LANES
#else
#define RAYGRAIN_LANES _Pragma("GCC ivdep") _Pragma("GCC unroll 1")
#endif

inline EightFloats lesser(const EightFloats& a, const EightFloats& b) {
  EightFloats result;
  RAYGRAIN_LANES
  for (int i = 0; i < 8; ++i) result.at[i] = a.at[i] < b.at[i] ? a.at[i] : b.at[i];
  return result;
}

/// A box as (lo, -, -hi, -): eight minima extend it.
struct PackedBox {
  EightFloats lanes{{kInf, kInf, kInf, 0, kInf, kInf, kInf, 0}};

  static PackedBox of(const Bounds& b) { return {{{b.lo.x, b.lo.y, b.lo.z, 0, -b.hi.x, -b.hi.y, -b.hi.z, 0}}}; }
  Bounds unpacked() const {
    return {{lanes.at[0], lanes.at[1], lanes.at[2]}, {-lanes.at[4], -lanes.at[5], -lanes.at[6]}};
  }
  float lo(int axis) const { return lanes.at[axis]; }
  float hi(int axis) const { return -lanes.at[axis + 4]; }
  float length(int axis) const { return hi(axis) - lo(axis); }
  void set_lo(int axis, float value) { lanes.at[axis] = value; }
  void set_hi(int axis, float value) { lanes.at[axis + 4] = -value; }
  void extend(const PackedBox& other) { lanes = lesser(other.lanes, lanes); }
};

/// One primitive, or the part of one that spatial splits left in a node. The id stands in the box's unused fourth
/// number.
struct Reference {
  PackedBox box;
  FourFloats key;  // along x, y and z, and 0

  static Reference of(const Bounds& bounds, Vec3 key, uint32_t id) {
    Reference result{PackedBox::of(bounds), {{key.x, key.y, key.z, 0}}};
    result.box.lanes.at[3] = std::bit_cast<float>(id);
    return result;
  }
  uint32_t id() const { return std::bit_cast<uint32_t>(box.lanes.at[3]); }
  EightFloats key_lanes() const {
    EightFloats result;
    RAYGRAIN_LANES
    for (int i = 0; i < 4; ++i) {
      result.at[i] = key.at[i];
      result.at[i + 4] = -key.at[i];
    }
    return result;
  }
  PackedBox key_box() const { return {key_lanes()}; }
};

}  // namespace raygrain::builder
