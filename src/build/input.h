// What every builder is given, checked.
#pragma once

#include <span>
#include <vector>

#include "raygrain/bounds.h"

namespace raygrain::builder {

/// Boxes and centroids are parallel; no centroids stand for the centers of the boxes.
struct Input {
  std::span<const Bounds> bounds;
  std::span<const Vec3> centroids;
  Bounds reach;  // of all boxes and centroids
};

/// Throws Error kUsage unless sizes agree, boxes are finite and not empty and centroids are finite; kLimit for more
/// primitives than node indices can name.
Input checked_input(std::span<const Bounds> bounds, std::span<const Vec3> centroids, unsigned threads);

/// The centers of the boxes, for builders that ask for every centroid.
std::vector<Vec3> box_centers(std::span<const Bounds> bounds, unsigned threads);

}  // namespace raygrain::builder
