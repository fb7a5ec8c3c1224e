// Rays that surely concern no structure of any area, told quickly: they go to the global tree without further
// questions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raygrain/area.h"

namespace raygrain {

/// Which of an area's rays matter.
enum class Reach : uint8_t {
  kNone,       // none: the global tree answers all of them
  kAxis,       // those along its direction or through its point, up to rounding
  kTolerance,  // those within its tolerance
};

/// Does the ray's line pass the point by, at a sine of more than the root of `greatest_square`? False for invalid rays.
inline bool passes_by(const Ray& ray, Vec3 point, float greatest_square) {
  const Vec3 away = ray.origin - point, beside = cross(away, ray.direction);
  const float bound = greatest_square * dot(ray.direction, ray.direction) * dot(away, away);
  return bound > 0 && dot(beside, beside) > bound;  // where squares are 0 as floats, nothing is sure
}

/// Coverage takes rays that leave its columns by a slope of 2^-22; floats see that as a sine of less than this.
inline constexpr double kAxisSine = 0x1p-18;
inline constexpr float kAxisSquare = static_cast<float>(kAxisSine * kAxisSine * (1 + 0x1p-18));

/// Tells by the line alone. Whoever passes may still be foreign; nobody's answer depends on it.
class ForeignFilter {
 public:
  ForeignFilter() = default;
  /// `reaches` are parallel to `areas`.
  ForeignFilter(std::span<const AreaGeometry> areas, std::span<const Reach> reaches);

  /// Every ray is.
  bool is_trivial() const { return axes_.empty() && eyes_.empty(); }

  size_t memory_bytes() const { return axes_.capacity() * sizeof(Axis) + eyes_.capacity() * sizeof(Eye); }

  /// The ray concerns no area. Anything for invalid rays: they miss wherever they go.
  bool is_foreign(const Ray& ray) const {
    const float size = dot(ray.direction, ray.direction);
    for (const Axis& axis : axes_) {
      const Vec3 beside = cross(axis.direction, ray.direction);
      const float bound = axis.greatest_square * size;
      if (!(bound > 0 && dot(beside, beside) > bound)) return false;
    }
    for (const Eye& eye : eyes_)
      if (!passes_by(ray, eye.place, eye.greatest_square)) return false;
    return true;
  }

 private:
  // Squares of the greatest |sin| of an angle that matters, greater by more than all rounding.
  struct Axis {
    Vec3 direction;
    float greatest_square;
  };
  struct Eye {
    Vec3 place;
    float greatest_square;
  };
  std::vector<Axis> axes_;
  std::vector<Eye> eyes_;  // each once
};

}  // namespace raygrain
