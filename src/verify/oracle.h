// Brute force: every triangle, one intersector.
#pragma once

#include <array>
#include <vector>

#include "raygrain/mesh.h"
#include "raygrain/ray.h"

namespace raygrain::verification {

/// The same answers as intersect_reference, from corners that lie beside each other.
class Oracle {
 public:
  explicit Oracle(const TriangleMesh& mesh);

  Hit nearest(const Ray& ray) const;

  /// Of the whole line, both ways.
  struct Crossings {
    size_t count = 0;
    bool touches_edge = false;  // of a triangle that it meets; then `count` says nothing
  };
  Crossings crossings(const Ray& line) const;

  /// Does the line touch any edge, also of triangles that it does not meet because it lies in their plane? Slow.
  bool touches_any_edge(const Ray& line) const;

 private:
  std::vector<std::array<Vec3, 3>> corners_;
};

}  // namespace raygrain::verification
