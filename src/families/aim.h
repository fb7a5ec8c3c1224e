// Points and directions that suit one mesh.
#pragma once

#include <array>

#include "raygrain/families.h"

#include "base/random.h"

namespace raygrain {

/// Everything in double, to be rounded to float at the end.
class Aim {
 public:
  Aim(const TriangleMesh& mesh, uint64_t seed);

  /// Anywhere in or around the mesh, half of the points with few bits so that differences to vertices are exact.
  Vec3d place();
  Vec3d direction();
  std::array<Vec3d, 3> triangle();
  Vec3d vertex() { return triangle()[random.below(3)]; }
  /// The middle of an edge (often exact), or anywhere on it.
  Vec3d edge_point();
  Vec3d surface_point();
  /// A vertex, a point of an edge, or one of a face.
  Vec3d target();
  Ray towards(Vec3d target);
  double signed_uniform() { return random.uniform(-1, 1); }
  /// Half of the mesh's longest side; 0 for a point or nothing.
  double size() const { return size_; }

 private:
  const TriangleMesh& mesh_;
  Vec3d middle_, half_{1, 1, 1};
  double unit_ = 0x1p-10, size_ = 0;

 public:
  Random random;
};

}  // namespace raygrain
