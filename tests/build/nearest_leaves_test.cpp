// Many points sorted down a tree together come where each alone comes.
#include "build/nearest_leaves.h"

#include <algorithm>

#include "build/build_support.h"

namespace raygrain::test {
namespace {

float square_distance(const Bounds& box, Vec3 p) {
  float sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float outside = std::max({box.lo[axis] - p[axis], p[axis] - box.hi[axis], 0.0f});
    sum += outside * outside;
  }
  return sum;
}

double middle_distance(const Bounds& box, Vec3 p) {
  const Vec3d d = to_double(center(box)) - to_double(p);
  return dot(d, d);
}

uint32_t leaf_of(const Bvh& tree, Vec3 p) {
  uint32_t node = 0;
  while (!tree.nodes[node].is_leaf()) {
    const uint32_t left = tree.nodes[node].first;
    const Bounds &a = tree.nodes[left].bounds, &b = tree.nodes[left + 1].bounds;
    const float to_a = square_distance(a, p), to_b = square_distance(b, p);
    node = (to_a != to_b ? to_b < to_a : middle_distance(b, p) < middle_distance(a, p)) ? left + 1 : left;
  }
  return node;
}

TEST(NearestLeaves, AreThoseOfEachPointAlone) {
  builder::NearestLeaves search;
  for (const size_t count : {1u, 2u, 50u, 3000u}) {
    SCOPED_TRACE(count);
    const Bvh tree = binned(random_prims(count, count));
    Random random(count);
    std::vector<Vec3> points;
    for (size_t i = 0; i < 5 * count + 1; ++i) points.push_back(random_point(random, -5, 15));
    for (const Bvh::Node& node : tree.nodes)
      points.push_back(random.below(2) == 0 ? center(node.bounds) : node.bounds.hi);
    std::vector<uint32_t> leaves(points.size());
    search.find(tree, points, leaves);
    for (size_t i = 0; i < points.size(); ++i) ASSERT_EQ(leaves[i], leaf_of(tree, points[i])) << i;
  }
}

}  // namespace
}  // namespace raygrain::test
