// What every builder is given, checked.
#pragma once

#include <span>
#include <vector>

#include "raygrain/bounds.h"

namespace raygrain::builder {

/// Boxes and centroids are parallel.
struct Input {
  std::span<const Bounds> bounds;
  std::span<const Vec3> centroids;
  Bounds reach;  // of all boxes and centroids
};

/// The input with its centroids, or where there are none with the centers of the boxes, which `centers` then holds.
/// Throws Error kUsage unless sizes agree, boxes are finite and not empty and centroids are finite; kLimit for more
/// primitives than node indices can name.
Input checked_input(std::span<const Bounds> bounds, std::span<const Vec3> centroids, std::vector<Vec3>& centers,
                    unsigned threads);

}  // namespace raygrain::builder
