#include "io/value_noise.h"

#include <cmath>

#include "base/random.h"

namespace raygrain {
namespace {

double lattice_value(int64_t i, int64_t j, uint64_t seed) {
  const auto column = static_cast<uint64_t>(i), row = static_cast<uint64_t>(j);
  return Random(Random(Random(seed).next() + column).next() + row).uniform();
}

// Perlin's quintic ("Improving noise", 2002): first and second derivative vanish at both ends.
double smooth_step(double t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

template <class Shape>
double sum_octaves(double x, double z, int octaves, uint64_t seed, const Shape& shape) {
  double sum = 0, weight = 1, total = 0;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += weight * shape(value_noise(x, z, seed + static_cast<uint64_t>(octave)));
    total += weight;
    weight *= 0.5;
    // Turned and shifted, so that the lattices of the octaves neither align nor coincide.
    const double turned = 2 * (0.8 * x - 0.6 * z) + 0.37;
    z = 2 * (0.6 * x + 0.8 * z) + 0.71;
    x = turned;
  }
  return sum / total;
}

}  // namespace

double value_noise(double x, double z, uint64_t seed) {
  const double column = std::floor(x), row = std::floor(z);
  const auto i = static_cast<int64_t>(column), j = static_cast<int64_t>(row);
  const double u = smooth_step(x - column), v = smooth_step(z - row);
  const double near = lattice_value(i, j, seed) * (1 - u) + lattice_value(i + 1, j, seed) * u;
  const double far = lattice_value(i, j + 1, seed) * (1 - u) + lattice_value(i + 1, j + 1, seed) * u;
  return near * (1 - v) + far * v;
}

double fractal_noise(double x, double z, int octaves, uint64_t seed) {
  return sum_octaves(x, z, octaves, seed, [](double value) { return value; });
}

double ridged_noise(double x, double z, int octaves, uint64_t seed) {
  return sum_octaves(x, z, octaves, seed, [](double value) {
    const double ridge = 1 - std::abs(2 * value - 1);
    return ridge * ridge;
  });
}

}  // namespace raygrain
