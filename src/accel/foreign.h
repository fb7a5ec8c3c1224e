// Rays that surely are no area's own, told quickly: they go to the global tree without further questions.
#pragma once

#include <span>
#include <vector>

#include "raygrain/area.h"

namespace raygrain {

/// Tells by the direction alone. Whoever passes may still be foreign; nobody's answer depends on it.
class ForeignFilter {
 public:
  ForeignFilter() = default;
  explicit ForeignFilter(std::span<const AreaGeometry> areas);

  /// No area has this direction, up to its tolerance. False for invalid rays.
  bool is_foreign(const Ray& ray) const {
    const float size = dot(ray.direction, ray.direction);
    for (const Axis& axis : axes_) {
      const float along = dot(axis.direction, ray.direction);
      if (!(along * along < axis.least_square * size)) return false;
    }
    for (const Eye& eye : eyes_) {
      const Vec3 away = ray.origin - eye.place;
      const float along = dot(away, ray.direction);
      if (!(along * along < eye.least_square * size * dot(away, away))) return false;
    }
    return true;
  }

 private:
  // Squares of the least |cos| of an affine direction, less by more than all rounding.
  struct Axis {
    Vec3 direction;
    float least_square;
  };
  struct Eye {
    Vec3 place;
    float least_square;
  };
  std::vector<Axis> axes_;
  std::vector<Eye> eyes_;  // each once
};

}  // namespace raygrain
