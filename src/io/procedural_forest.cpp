#include <algorithm>

#include "base/random.h"
#include "io/mesh_builder.h"
#include "io/procedural.h"
#include "io/value_noise.h"

namespace raygrain {
namespace {

constexpr double kSpacing = 6;  // metres between trees
constexpr double kCell = 2;     // metres, of the ground's grid

double ground_height(double x, double z, uint64_t seed) {
  return 14 * fractal_noise(x / 60, z / 60, 3, seed) + 0.5 * value_noise(x / 3, z / 3, seed + 50);
}

// Uniform in the unit ball by rejection: no trigonometry.
Vec3d random_in_ball(Random& random) {
  for (;;) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const Vec3d v{x, y, z};
    if (dot(v, v) <= 1 && dot(v, v) > 1e-6) return v;
  }
}

// A leaf of `size` metres at `stem`, hanging along `outward` more or less.
void add_leaf(MeshBuilder& builder, Random& random, Vec3d stem, Vec3d outward, double size) {
  const Vec3d along = normalized(outward + random_in_ball(random) * 0.9 + Vec3d{0, -0.2, 0});
  const Vec3d aside = cross(along, normalized(random_in_ball(random)));
  const Vec3d middle = stem + along * (size * 0.55);
  builder.triangle(stem, middle + aside * (size * 0.35), stem + along * size);
  builder.triangle(stem, stem + along * size, middle - aside * (size * 0.35));
}

void add_conifer(MeshBuilder& builder, Random& random, Vec3d foot) {
  const double height = random.uniform(8, 15), reach = height * random.uniform(0.16, 0.22);
  builder.column({foot, height * 0.02, 0, height, 6});
  const auto whorls = static_cast<int>(9 + random.below(4));
  for (int whorl = 0; whorl < whorls; ++whorl) {
    const double share = (whorl + 0.5) / whorls;
    const Vec3d origin = foot + Vec3d{0, height * (0.15 + 0.83 * share), 0};
    const double length = reach * (1.05 - share);
    for (int branch = 0; branch < 7; ++branch) {
      Vec3d outward = random_in_ball(random);
      outward = normalized(Vec3d{outward.x, 0, outward.z} + Vec3d{1e-3, 0, 0});
      const Vec3d tip = origin + outward * length + Vec3d{0, -0.3 * length, 0};
      for (int i = 1; i <= 2; ++i)
        add_leaf(builder, random, origin + (tip - origin) * (0.4 * i), outward, length * 0.5);
      builder.triangle(origin + Vec3d{0, 0.12, 0}, origin - Vec3d{0, 0.12, 0}, tip);
    }
  }
}

void add_broadleaf(MeshBuilder& builder, Random& random, Vec3d foot) {
  const double height = random.uniform(6, 11), fork = height * random.uniform(0.3, 0.4);
  const Vec3d top = foot + Vec3d{0, fork, 0};
  builder.limb(foot, top, height * 0.03, height * 0.022, 8);
  const double crown = height * 0.3;
  const auto branches = static_cast<int>(4 + random.below(3));
  for (int branch = 0; branch < branches; ++branch) {
    const Vec3d aside = random_in_ball(random);
    const Vec3d end = top + Vec3d{aside.x * crown * 0.8, crown * random.uniform(0.7, 1.6), aside.z * crown * 0.8};
    builder.limb(top, end, height * 0.016, 0, 5);
    const auto leaves = static_cast<int>(30 + random.below(16));
    for (int i = 0; i < leaves; ++i) {
      const Vec3d outward = random_in_ball(random);
      add_leaf(builder, random, end + outward * (crown * 0.62), outward, random.uniform(0.4, 0.85));
    }
  }
}

void add_bush(MeshBuilder& builder, Random& random, Vec3d foot) {
  for (int i = 0; i < 16; ++i) {
    const Vec3d outward = random_in_ball(random);
    const Vec3d stem = foot + Vec3d{outward.x * 0.5, std::abs(outward.y) * 0.6, outward.z * 0.5};
    add_leaf(builder, random, stem, {outward.x, std::abs(outward.y) + 0.3, outward.z}, random.uniform(0.2, 0.5));
  }
}

}  // namespace

TriangleMesh make_forest(uint32_t size, uint64_t seed) {
  MeshBuilder builder;
  const double half = kSpacing * size / 2;
  const auto cells = static_cast<uint32_t>(kSpacing / kCell) * size;
  builder.grid(cells, cells, [=](uint32_t i, uint32_t j) {
    const double x = i * kCell - half, z = j * kCell - half;
    return Vec3d{x, ground_height(x, z, seed), z};
  });
  Random forest(seed);
  for (uint32_t row = 0; row < size; ++row)
    for (uint32_t column = 0; column < size; ++column) {
      Random random(forest.next());
      const auto place = [&](double corner_x, double corner_z) {
        const double x = corner_x + random.uniform(0.1, 0.9) * kSpacing;
        const double z = corner_z + random.uniform(0.1, 0.9) * kSpacing;
        return Vec3d{x, ground_height(x, z, seed) - 0.15, z};  // rooted a little below the coarser mesh of the ground
      };
      const double x = column * kSpacing - half, z = row * kSpacing - half;
      const bool conifer = random.uniform() < fractal_noise(x / 40, z / 40, 2, seed + 300);
      if (conifer)
        add_conifer(builder, random, place(x, z));
      else
        add_broadleaf(builder, random, place(x, z));
      if (random.below(3) == 0) add_bush(builder, random, place(x, z));
    }
  return builder.take();
}

}  // namespace raygrain
