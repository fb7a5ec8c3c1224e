// Directions of a cone, evenly spread: what stands for the rays of an area where nobody gives samples.
#pragma once

#include <cmath>
#include <cstddef>

#include "raygrain/frame.h"

#include "base/trigonometry.h"

namespace raygrain {

/// The i-th of `count` unit vectors in the cap of half angle acos(1 - tolerance) around `axes.forward`, evenly by solid
/// angle: equal heights of a sphere have equal areas (Archimedes), and turns by the golden angle fill the circle. With
/// tolerance 1 half a sphere, and each comes nearer to the axis as the tolerance shrinks.
inline Vec3d cone_direction(const Frame& axes, double tolerance, size_t i, size_t count) {
  constexpr double kGoldenAngle = 2.3999632297286533;
  const double place = static_cast<double>(i) + 0.5;
  const double below_top = tolerance * place / static_cast<double>(count);
  const double radius = std::sqrt(below_top * (2 - below_top));
  const SineCosine turn = sine_cosine(kGoldenAngle * place);
  return to_world_direction(axes, {radius * turn.cosine, radius * turn.sine, 1 - below_top});
}

}  // namespace raygrain
