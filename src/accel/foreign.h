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

/// Tells by the line alone. Whoever passes may still be foreign; nobody's answer depends on it.
class ForeignFilter {
 public:
  ForeignFilter() = default;
  /// `reaches` are parallel to `areas`.
  ForeignFilter(std::span<const AreaGeometry> areas, std::span<const Reach> reaches);

  /// Every ray is.
  bool is_trivial() const { return axes_.empty() && eyes_.empty(); }

  size_t memory_bytes() const { return axes_.capacity() * sizeof(Axis) + eyes_.capacity() * sizeof(Eye); }

  /// The ray concerns no area. False for invalid rays, unless all are foreign.
  bool is_foreign(const Ray& ray) const {
    const float size = dot(ray.direction, ray.direction);
    for (const Axis& axis : axes_) {
      const Vec3 beside = cross(axis.direction, ray.direction);
      if (!(dot(beside, beside) > axis.greatest_square * size)) return false;
    }
    for (const Eye& eye : eyes_) {
      const Vec3 away = ray.origin - eye.place, beside = cross(away, ray.direction);
      if (!(dot(beside, beside) > eye.greatest_square * size * dot(away, away))) return false;
    }
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
