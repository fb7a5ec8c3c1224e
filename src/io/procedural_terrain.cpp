#include "io/mesh_builder.h"
#include "io/procedural.h"
#include "io/value_noise.h"

namespace raygrain {
namespace {

constexpr double kSide = 1000;   // metres
constexpr double kPeak = 260;    // metres above the lowest valley
constexpr double kScale = 4;     // lattice cells of the coarsest octave per side
constexpr int kFineOctaves = 8;  // the finest is 2 m wide

double height(double x, double z, uint64_t seed) {
  const double u = x / kSide * kScale, v = z / kSide * kScale;
  const double ridges = ridged_noise(u, v, 5, seed);
  const double mass = fractal_noise(u * 0.5, v * 0.5, 3, seed + 100);
  const double detail = fractal_noise(u * 2, v * 2, kFineOctaves, seed + 200);
  return kPeak * (0.75 * ridges * mass + 0.25 * mass * mass + 0.12 * detail);
}

}  // namespace

TriangleMesh make_terrain(uint32_t size, uint64_t seed) {
  MeshBuilder builder;
  builder.grid(size, size, [=](uint32_t i, uint32_t j) {
    const double x = kSide * i / size, z = kSide * j / size;
    return Vec3d{x - kSide / 2, height(x, z, seed), z - kSide / 2};
  });
  return builder.take();
}

}  // namespace raygrain
