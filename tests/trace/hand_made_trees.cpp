#include "trace/hand_made_trees.h"

#include <algorithm>
#include <numeric>

namespace raygrain::test {
namespace {

void split(const TriangleMesh& mesh, SplitRule rule, Bvh& bvh, uint32_t index, uint32_t first, uint32_t count,
           uint32_t level) {
  Bounds box, centroids;
  for (uint32_t i = first; i < first + count; ++i) {
    box.extend(triangle_bounds(mesh, bvh.prims[i]));
    centroids.extend(triangle_centroid(mesh, bvh.prims[i]));
  }
  const uint32_t left = count > 1 && level < kMaxTreeLevels - 1 ? rule(count, level) : 0;
  bvh.nodes[index] = {box, first, count};
  if (left == 0) return;
  const int axis = longest_axis(centroids);
  std::stable_sort(bvh.prims.begin() + first, bvh.prims.begin() + first + count, [&](uint32_t a, uint32_t b) {
    return triangle_centroid(mesh, a)[axis] < triangle_centroid(mesh, b)[axis];
  });
  const auto children = static_cast<uint32_t>(bvh.nodes.size());
  bvh.nodes.resize(children + 2);
  bvh.nodes[index] = {box, children, 0};
  split(mesh, rule, bvh, children, first, left, level + 1);
  split(mesh, rule, bvh, children + 1, first + left, count - left, level + 1);
}

}  // namespace

Bvh split_tree(const TriangleMesh& mesh, const std::vector<uint32_t>& triangles, SplitRule rule) {
  Bvh bvh;
  if (triangles.empty()) return bvh;
  bvh.prims = triangles;
  bvh.nodes.resize(1);
  split(mesh, rule, bvh, 0, 0, static_cast<uint32_t>(triangles.size()), 0);
  return bvh;
}

std::vector<uint32_t> all_triangles(const TriangleMesh& mesh) {
  std::vector<uint32_t> ids(mesh.triangle_count());
  std::iota(ids.begin(), ids.end(), 0u);
  return ids;
}

std::vector<NamedTree> hand_made_trees(const TriangleMesh& mesh) {
  const std::vector<uint32_t> ids = all_triangles(mesh);
  std::vector<uint32_t> reversed(ids.rbegin(), ids.rend());
  return {{"one leaf", split_tree(mesh, reversed, [](uint32_t, uint32_t) { return 0u; })},
          {"halves", split_tree(mesh, ids, [](uint32_t count, uint32_t) { return count / 2; })},
          {"halves of four", split_tree(mesh, reversed, [](uint32_t n, uint32_t) { return n > 4 ? n / 2 : 0; })},
          {"chain", split_tree(mesh, ids, [](uint32_t count, uint32_t level) { return level % 2 ? 1 : count - 1; })}};
}

}  // namespace raygrain::test
