// The binary bounding volume hierarchy that every builder returns and every analysis reads.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "raygrain/bounds.h"

namespace raygrain {

/// Deepest level that a tree may have: the bound of every traversal stack.
inline constexpr uint32_t kMaxTreeLevels = 256;

/// nodes[0] is the root (no nodes at all for no primitives). An inner node (count == 0) has its children at `first` and
/// `first + 1`, both after it. A leaf holds prims[first ... first + count).
struct Bvh {
  struct Node {
    Bounds bounds;
    uint32_t first = 0, count = 0;

    bool is_leaf() const { return count != 0; }
  };
  std::vector<Node> nodes;
  std::vector<uint32_t> prims;  // primitive (triangle) ids, each once unless references are split
  /// Several leaves may hold parts of one primitive: each leaf's box then holds only the part of the primitive that it
  /// answers for, and `prims` may be longer than the number of primitives.
  bool split_references = false;
};

/// Bytes held by the tree.
size_t memory_bytes(const Bvh& bvh);

/// Depth in edges of the deepest node; 0 for an empty tree.
uint32_t max_level(const Bvh& bvh);

/// The first thing wrong with a tree over primitives with these boxes (ids index `primitive_bounds`), as a sentence
/// that names the node, or nothing: links in range, acyclic and complete; each of `expected_prims` in exactly one leaf
/// (empty: every box); each box holding its children and primitives; depth within kMaxTreeLevels; no NaN. Of split
/// references: each in at least one leaf, in none twice, every leaf's box meeting its box, and their leaves' boxes
/// together reaching as far as it does.
std::optional<std::string> find_defect(const Bvh& bvh, std::span<const Bounds> primitive_bounds,
                                       std::span<const uint32_t> expected_prims = {});

}  // namespace raygrain
