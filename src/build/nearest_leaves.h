// The leaf of a tree that is nearest to each of many points, as far as a way down without return can tell.
#pragma once

#include <span>
#include <vector>

#include "raygrain/bvh.h"

namespace raygrain::builder {

/// From the root down to the nearer box; where a point is as near to both, or in both, to the one with the nearer
/// middle. All points of a node go on together, so that the processor need not wait for one point's way. Keeps its
/// memory.
class NearestLeaves {
 public:
  /// leaves[i]: the node of points[i]'s leaf. The tree is not empty.
  void find(const Bvh& tree, std::span<const Vec3> points, std::span<uint32_t> leaves);

 private:
  struct Points {
    std::vector<float> x, y, z;
    std::vector<uint32_t> number;

    void resize(size_t size);
    void copy(size_t to, const Points& from, size_t at) {
      x[to] = from.x[at];
      y[to] = from.y[at];
      z[to] = from.z[at];
      number[to] = from.number[at];
    }
  };

  size_t part(const Bounds& left, const Bounds& right, size_t begin, size_t end);
  void measure(Bounds box, size_t begin, size_t end, std::vector<float>& distances) const;

  Points points_, right_;
  std::vector<float> to_left_, to_right_;  // squares of distances
};

}  // namespace raygrain::builder
