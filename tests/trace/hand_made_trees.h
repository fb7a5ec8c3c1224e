// Simple trees of known shape, so that these tests lean on no builder.
#pragma once

#include <string>
#include <vector>

#include "raygrain/bvh.h"
#include "raygrain/mesh.h"

namespace raygrain::test {

struct NamedTree {
  std::string name;
  Bvh bvh;
};

/// How many of `count` sorted triangles go to the left child; 0 makes a leaf.
using SplitRule = uint32_t (*)(uint32_t count, uint32_t level);

/// A tree over the given triangles, sorted along the longest axis at every node and split by `rule`. Boxes are tight.
Bvh split_tree(const TriangleMesh& mesh, const std::vector<uint32_t>& triangles, SplitRule rule);

/// All triangles of the mesh.
std::vector<uint32_t> all_triangles(const TriangleMesh& mesh);

/// One leaf; halves with one triangle or up to four per leaf; a chain as deep as trees may be.
std::vector<NamedTree> hand_made_trees(const TriangleMesh& mesh);

}  // namespace raygrain::test
