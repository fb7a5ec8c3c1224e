// Small triangles anywhere in a box.
#pragma once

#include <cstdint>

#include "raygrain/mesh.h"

#include "base/random.h"

namespace raygrain::test {

/// Each has a corner in [0, 100]^3 and the other two within one unit of it along each axis.
inline TriangleMesh triangle_soup(uint32_t count, uint64_t seed) {
  Random random(seed);
  const auto point = [&](double size) {
    const double x = random.uniform(0, size), y = random.uniform(0, size);
    return to_float(Vec3d{x, y, random.uniform(0, size)});
  };
  TriangleMesh mesh;
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3 corner = point(100);
    mesh.vertices.insert(mesh.vertices.end(), {corner, corner + point(1), corner + point(1)});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

}  // namespace raygrain::test
