// Small closed shapes for procedural scenes: y is up, outward faces run counterclockwise. Coordinates are double and
// rounded once, when a vertex is stored.
#pragma once

#include <cstdint>

#include "raygrain/mesh.h"

namespace raygrain {

/// A box with sides along the axes.
struct Block {
  Vec3d lo, hi;
};

/// The faces of a block that are worth triangles, as bits.
enum BlockFaces : unsigned {
  kSides = 1,
  kTop = 2,
  kBottom = 4,
  kSidesAndTop = kSides | kTop,
  kAllFaces = kSides | kTop | kBottom,
};

/// A vertical prism, cone (top_radius 0) or truncated cone.
struct Column {
  Vec3d base;
  double bottom_radius = 1, top_radius = 1, height = 1;
  int sides = 6;
};

class MeshBuilder {
 public:
  uint32_t vertex(Vec3d position);
  void triangle(uint32_t a, uint32_t b, uint32_t c) { mesh_.triangles.push_back({a, b, c}); }
  void triangle(Vec3d a, Vec3d b, Vec3d c);
  /// Two triangles; a, b, c, d run around the face.
  void quad(uint32_t a, uint32_t b, uint32_t c, uint32_t d);
  void quad(Vec3d a, Vec3d b, Vec3d c, Vec3d d);

  void block(const Block& block, unsigned faces);
  /// A roof of two slopes and two gables on top of `base`; the ridge runs along x or z. The base itself is left open.
  void gable_roof(const Block& base, double ridge_height, bool ridge_along_x);
  /// The mantle, and the top where it has one.
  void column(const Column& column);
  /// A column between any two points, open at both ends: branches and cables.
  void limb(Vec3d from, Vec3d to, double from_radius, double to_radius, int sides);
  /// A height field: `columns` x `rows` cells; position(i, j) gives the corner i along x and j along z.
  template <class Position>
  void grid(uint32_t columns, uint32_t rows, const Position& position) {
    const auto first = static_cast<uint32_t>(mesh_.vertices.size());
    for (uint32_t j = 0; j <= rows; ++j)
      for (uint32_t i = 0; i <= columns; ++i) vertex(position(i, j));
    for (uint32_t j = 0; j < rows; ++j)
      for (uint32_t i = 0; i < columns; ++i) {
        const uint32_t corner = first + j * (columns + 1) + i;
        quad(corner, corner + columns + 1, corner + columns + 2, corner + 1);
      }
  }

  TriangleMesh take() { return std::move(mesh_); }

 private:
  TriangleMesh mesh_;
};

}  // namespace raygrain
