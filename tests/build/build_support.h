// Primitives for builder tests, and comparison of trees.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "raygrain/build.h"
#include "raygrain/mesh.h"

#include "base/random.h"

namespace raygrain::test {

struct Prims {
  std::vector<Bounds> bounds;
  std::vector<Vec3> centroids;

  void add(const Bounds& box) { add(box, center(box)); }
  void add(const Bounds& box, Vec3 centroid) {
    bounds.push_back(box);
    centroids.push_back(centroid);
  }
};

inline Prims prims_of(const TriangleMesh& mesh) {
  return {triangle_bounds(mesh), triangle_centroids(mesh)};
}

inline Vec3 random_point(Random& random, double lo, double hi) {
  return to_float(Vec3d{random.uniform(lo, hi), random.uniform(lo, hi), random.uniform(lo, hi)});
}

/// Small triangles in [0, 10]^3: random walks of three points.
inline Prims random_prims(size_t count, uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3 a = random_point(random, 0, 10), b = a + random_point(random, -1, 1),
               c = b + random_point(random, -1, 1);
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return prims_of(mesh);
}

/// Unit cubes whose lower corners stand at `corners`.
inline Prims cubes(std::initializer_list<Vec3> corners) {
  Prims prims;
  for (const Vec3 corner : corners) prims.add({corner, corner + Vec3{1, 1, 1}});
  return prims;
}

inline bool same_tree(const Bvh& a, const Bvh& b) {
  if (a.prims != b.prims || a.nodes.size() != b.nodes.size()) return false;
  for (size_t i = 0; i < a.nodes.size(); ++i)
    if (a.nodes[i].bounds != b.nodes[i].bounds || a.nodes[i].first != b.nodes[i].first ||
        a.nodes[i].count != b.nodes[i].count)
      return false;
  return true;
}

inline size_t largest_leaf(const Bvh& bvh) {
  size_t largest = 0;
  for (const Bvh::Node& node : bvh.nodes)
    if (node.count > largest) largest = node.count;
  return largest;
}

inline size_t inner_nodes(const Bvh& bvh) {
  return bvh.nodes.size() / 2;
}

inline Bvh paper(const Prims& prims, const BuildOptions& options = {}, BuildLog* log = nullptr) {
  return build_paper(prims.bounds, prims.centroids, options, log);
}
inline Bvh binned(const Prims& prims, const BuildOptions& options = {}, BuildLog* log = nullptr) {
  return build_binned(prims.bounds, prims.centroids, options, log);
}

/// An orientation that always gives these choices.
inline SplitOrientation fixed_axes(std::vector<AxisChoice> choices) {
  return [choices](const NodeContext&) {
    AxisOrder order;
    for (const AxisChoice choice : choices) order.push(choice);
    return order;
  };
}

}  // namespace raygrain::test
