#include "rays/ray_random.h"

#include <algorithm>
#include <cmath>

#include "raygrain/frame.h"

#include "base/trigonometry.h"

namespace raygrain {

Vec3d random_in_disc(Random& random, double radius) {
  const double r = radius * std::sqrt(random.uniform());
  const SineCosine angle = sine_cosine(2 * kPi * random.uniform());
  return {r * angle.cosine, r * angle.sine, 0};
}

Vec3d random_in_cap(Random& random, Vec3d axis, double cosine) {
  // Archimedes: equal heights of a sphere have equal areas, so the height is uniform.
  const double height = 1 - random.uniform() * (1 - cosine);
  const double radius = std::sqrt(std::max(0.0, 1 - height * height));
  const SineCosine angle = sine_cosine(2 * kPi * random.uniform());
  const Frame frame = make_frame({}, axis, {});
  return to_world_direction(frame, {radius * angle.cosine, radius * angle.sine, height});
}

}  // namespace raygrain
