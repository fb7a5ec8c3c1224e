// Axis-aligned boxes. A default-constructed box is empty and neutral under `extend`.
#pragma once

#include "raygrain/vec.h"

namespace raygrain {

struct Bounds {
  Vec3 lo{kInf, kInf, kInf}, hi{-kInf, -kInf, -kInf};

  constexpr void extend(Vec3 point) {
    lo = component_min(lo, point);
    hi = component_max(hi, point);
  }
  constexpr void extend(const Bounds& other) {
    lo = component_min(lo, other.lo);
    hi = component_max(hi, other.hi);
  }
  friend constexpr bool operator==(const Bounds&, const Bounds&) = default;
};

constexpr bool is_empty(const Bounds& b) {
  return !(b.lo.x <= b.hi.x && b.lo.y <= b.hi.y && b.lo.z <= b.hi.z);
}

constexpr Bounds united(Bounds a, const Bounds& b) {
  a.extend(b);
  return a;
}

/// The common part; empty when the boxes do not touch.
constexpr Bounds intersected(const Bounds& a, const Bounds& b) {
  return {component_max(a.lo, b.lo), component_min(a.hi, b.hi)};
}

/// Edge lengths; meaningless for an empty box.
constexpr Vec3 extent(const Bounds& b) {
  return b.hi - b.lo;
}

/// The middle, computed so that huge boxes do not overflow.
constexpr Vec3 center(const Bounds& b) {
  return b.lo * 0.5f + b.hi * 0.5f;
}

/// Closed containment.
constexpr bool contains(const Bounds& b, Vec3 p) {
  return b.lo.x <= p.x && p.x <= b.hi.x && b.lo.y <= p.y && p.y <= b.hi.y && b.lo.z <= p.z && p.z <= b.hi.z;
}
constexpr bool contains(const Bounds& outer, const Bounds& inner) {
  return contains(outer, inner.lo) && contains(outer, inner.hi);
}

/// The axis of the longest edge, the lower axis on a tie.
constexpr int longest_axis(const Bounds& b) {
  const Vec3 e = extent(b);
  return e.x >= e.y ? (e.x >= e.z ? 0 : 2) : (e.y >= e.z ? 1 : 2);
}

/// Corner `i` in 0..7: bit 0 chooses hi.x, bit 1 hi.y, bit 2 hi.z.
constexpr Vec3 corner(const Bounds& b, int i) {
  return {(i & 1) ? b.hi.x : b.lo.x, (i & 2) ? b.hi.y : b.lo.y, (i & 4) ? b.hi.z : b.lo.z};
}

}  // namespace raygrain
