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

struct alignas(16) FourInts {
  int32_t at[4];
};

// Tells GCC that lanes do not overlap, or it would not dare, and that it must not unroll the loop before it makes
// vectors of it; Clang sees both.
#ifdef __clang__
#define RAYGRAIN_LANES
#else
#define RAYGRAIN_LANES _Pragma("GCC ivdep") _Pragma("GCC unroll 1")
#endif

/// A box as (lo, -, -hi, -): eight minima extend it.
struct PackedBox {
  EightFloats lanes{{kInf, kInf, kInf, 0, kInf, kInf, kInf, 0}};

  static PackedBox of(const Bounds& b) { return {{{b.lo.x, b.lo.y, b.lo.z, 0, -b.hi.x, -b.hi.y, -b.hi.z, 0}}}; }
  Bounds unpacked() const {
    return {{lanes.at[0], lanes.at[1], lanes.at[2]}, {-lanes.at[4], -lanes.at[5], -lanes.at[6]}};
  }
  float lo(int axis) const { return lanes.at[axis]; }
  float hi(int axis) const { return -lanes.at[axis + 4]; }
  void set_lo(int axis, float value) { lanes.at[axis] = value; }
  void set_hi(int axis, float value) { lanes.at[axis + 4] = -value; }
  void extend(const PackedBox& other) {  // in place, or GCC keeps what is extended in a loop in memory
    RAYGRAIN_LANES
    for (int i = 0; i < 8; ++i) lanes.at[i] = other.lanes.at[i] < lanes.at[i] ? other.lanes.at[i] : lanes.at[i];
  }
};

/// The box of keys. The fourth numbers say nothing.
struct KeyBox {
  FourFloats lo{{kInf, kInf, kInf, kInf}}, hi{{-kInf, -kInf, -kInf, -kInf}};

  static KeyBox of(const Bounds& b) { return {{{b.lo.x, b.lo.y, b.lo.z, 0}}, {{b.hi.x, b.hi.y, b.hi.z, 0}}}; }
  float length(int axis) const { return hi.at[axis] - lo.at[axis]; }
  Bounds unpacked() const { return {{lo.at[0], lo.at[1], lo.at[2]}, {hi.at[0], hi.at[1], hi.at[2]}}; }
  void extend(const KeyBox& other) {
    RAYGRAIN_LANES
    for (int i = 0; i < 4; ++i) lo.at[i] = other.lo.at[i] < lo.at[i] ? other.lo.at[i] : lo.at[i];
    RAYGRAIN_LANES
    for (int i = 0; i < 4; ++i) hi.at[i] = other.hi.at[i] > hi.at[i] ? other.hi.at[i] : hi.at[i];
  }
  /// By the reference's key; with `away` = infinity by nothing, as a jump past it would, but without one. Nothing else
  /// in the loop: GCC takes values that leave it apart.
  template <class Reference>
  void extend(const Reference& reference, float away = 0) {
    RAYGRAIN_LANES
    for (int i = 0; i < 4; ++i) {
      const float low = reference.key(i) + away, high = reference.key(i) - away;
      lo.at[i] = low < lo.at[i] ? low : lo.at[i];
      hi.at[i] = high > hi.at[i] ? high : hi.at[i];
    }
  }
};

/// One primitive, or the part of one that spatial splits left in a node. Its key is twice the middle of its box. The id
/// stands in both of the box's unused numbers, so that their difference is 0.
struct Reference {
  PackedBox box;

  static Reference of(const Bounds& bounds, uint32_t id) {
    Reference result{PackedBox::of(bounds)};
    result.box.lanes.at[3] = result.box.lanes.at[7] = std::bit_cast<float>(id);
    return result;
  }
  uint32_t id() const { return std::bit_cast<uint32_t>(box.lanes.at[3]); }
  float key(int axis) const { return box.lanes.at[axis] - box.lanes.at[axis + 4]; }
  /// A part of the same primitive.
  Reference with_box(const Bounds& part) const { return of(part, id()); }
};

/// With a key of its own.
struct KeyedReference {
  PackedBox box;
  FourFloats own;

  static KeyedReference of(const Bounds& bounds, Vec3 key, uint32_t id) {
    return {Reference::of(bounds, id).box, {{key.x, key.y, key.z, 0}}};
  }
  uint32_t id() const { return std::bit_cast<uint32_t>(box.lanes.at[3]); }
  float key(int axis) const { return own.at[axis]; }
  KeyedReference with_box(const Bounds& part) const { return of(part, center(part), id()); }
};

}  // namespace raygrain::builder
