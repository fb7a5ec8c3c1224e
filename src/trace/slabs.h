// Where a ray is inside a box, in double precision and never too short: a box that holds a point of the ray is always
// met. The proof is in docs/theory.md, section "Exact intersection".
#pragma once

#include <cmath>

#include "raygrain/bounds.h"
#include "raygrain/ray.h"

namespace raygrain {

/// The parameters t from `entry` to `exit`; empty when entry > exit or either is NaN.
struct Interval {
  double entry, exit;
};

/// A valid ray, prepared for box tests.
class Slabs {
 public:
  explicit Slabs(const Ray& ray)
      : origin_(to_double(ray.origin)),
        inverse_{inverse(ray.direction.x), inverse(ray.direction.y), inverse(ray.direction.z)} {}

  /// An interval that holds every t of the whole line whose point is in the box.
  Interval operator()(const Bounds& box) const {
    double entry = -kInfinity, exit = kInfinity;
    cut(box.lo.x, box.hi.x, origin_.x, inverse_.x, entry, exit);
    cut(box.lo.y, box.hi.y, origin_.y, inverse_.y, entry, exit);
    cut(box.lo.z, box.hi.z, origin_.z, inverse_.z, entry, exit);
    return {entry - kPadding * std::abs(entry), exit + kPadding * std::abs(exit)};
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr double kPadding = 0x1p-50;  // 8 units of roundoff; 5 are needed

  static double inverse(float x) { return x == 0 ? kInfinity : 1 / static_cast<double>(x); }

  // A zero component has an infinite inverse. Then each side is at -infinity or +infinity, as it should: no limit for
  // an origin between the sides, an empty interval (in the end NaN) for one outside. An origin on a side gives
  // 0 * infinity = NaN, which no comparison takes up: no limit, for boxes are closed.
  static void cut(float lo, float hi, double origin, double inverse, double& entry, double& exit) {
    const double first = ((inverse < 0 ? hi : lo) - origin) * inverse;
    const double last = ((inverse < 0 ? lo : hi) - origin) * inverse;
    entry = first > entry ? first : entry;
    exit = last < exit ? last : exit;
  }

  Vec3d origin_, inverse_;
};

}  // namespace raygrain
