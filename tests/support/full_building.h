// A house that nobody sees into.
#pragma once

#include "support/triangle_soup.h"

namespace raygrain::test {

/// A closed box of tiled walls over [-1, 101]^3 with a soup of triangles in it: no ray from outside gets to the soup.
inline TriangleMesh full_building(uint32_t inside, uint64_t seed) {
  constexpr uint32_t kTiles = 12;  // along each edge of a wall
  constexpr float kLo = -1, kHi = 101, kTile = (kHi - kLo) / kTiles;
  TriangleMesh mesh = triangle_soup(inside, seed);
  const auto add_tile = [&](int axis, float wall, uint32_t i, uint32_t j) {
    const auto corner = [&](uint32_t u, uint32_t v) {
      Vec3 p;
      p[axis] = wall;
      p[(axis + 1) % 3] = kLo + kTile * static_cast<float>(u);
      p[(axis + 2) % 3] = kLo + kTile * static_cast<float>(v);
      return p;
    };
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const float wall : {kLo, kHi})
      for (uint32_t i = 0; i < kTiles; ++i)
        for (uint32_t j = 0; j < kTiles; ++j) add_tile(axis, wall, i, j);
  return mesh;
}

}  // namespace raygrain::test
