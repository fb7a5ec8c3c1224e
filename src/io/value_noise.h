// Value noise: random numbers on an integer grid, smoothly joined. The same bits on every machine.
#pragma once

#include <cstdint>

namespace raygrain {

/// In [0, 1), with continuous first and second derivatives; lattice spacing 1.
double value_noise(double x, double z, uint64_t seed);

/// `octaves` layers, each twice as fine and half as strong, scaled to [0, 1).
double fractal_noise(double x, double z, int octaves, uint64_t seed);

/// As fractal_noise, folded so that sharp ridges stand where it crosses its middle.
double ridged_noise(double x, double z, int octaves, uint64_t seed);

}  // namespace raygrain
