// Primitives as the fast builders hold them: box, id and key side by side, so that one pass reads memory once.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "raygrain/bounds.h"

#include "base/four_floats.h"

namespace raygrain::builder {

/// A box as (lo, -) and (-hi, -): two minima extend it.
struct PackedBox {
  FourFloats lower{kInf, kInf, kInf, 0}, upper{kInf, kInf, kInf, 0};

  static PackedBox of(const Bounds& b) {
    return {FourFloats{b.lo.x, b.lo.y, b.lo.z, 0}, FourFloats{-b.hi.x, -b.hi.y, -b.hi.z, 0}};
  }
  static PackedBox of_point(FourFloats p) { return {p, -p}; }
  Bounds unpacked() const { return {{lower[0], lower[1], lower[2]}, {-upper[0], -upper[1], -upper[2]}}; }
  float lo(int axis) const { return lower[axis]; }
  float hi(int axis) const { return -upper[axis]; }
  float length(int axis) const { return hi(axis) - lo(axis); }

  void extend(const PackedBox& other) {
    lower = lesser(other.lower, lower);
    upper = lesser(other.upper, upper);
  }
};

/// One primitive, or the part of one that spatial splits left in a node. The id stands in the box's unused fourth
/// number.
struct Reference {
  PackedBox box;
  FourFloats key;

  static Reference of(const Bounds& bounds, Vec3 key, uint32_t id) {
    Reference result{PackedBox::of(bounds), FourFloats{key.x, key.y, key.z, 0}};
    result.box.lower[3] = std::bit_cast<float>(id);
    return result;
  }
  uint32_t id() const { return std::bit_cast<uint32_t>(static_cast<float>(box.lower[3])); }
};

}  // namespace raygrain::builder
