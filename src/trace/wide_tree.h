// The memory of a wide tree: nodes of eight boxes, then leaves of up to eight triangles, in one block.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>

#include "raygrain/bounds.h"
#include "raygrain/mesh.h"
#include "raygrain/wide.h"

namespace raygrain {

inline constexpr size_t kWidth = 8;
inline constexpr size_t kCacheLine = 64;

/// A child: where it is, and for leaves how many triangles it has and how large they are. 0 stands for no child: the
/// root, at offset 0, is nobody's child.
///   bits 0-3: triangles (0 = a node), 4-19: upper half of a float, at least the longest edge component, 20-63: offset
using ChildRef = uint64_t;

inline ChildRef node_ref(uint64_t offset) {
  return offset << 20;
}
inline ChildRef leaf_ref(uint64_t offset, uint32_t count, float size) {
  const uint32_t above = std::bit_cast<uint32_t>(size) + 0xffffu;  // sizes are >= 0: rounds up, at worst to infinity
  return offset << 20 | static_cast<uint64_t>(above >> 16) << 4 | count;
}
inline uint32_t triangles_of(ChildRef ref) {
  return ref & 15;
}
inline float size_of(ChildRef ref) {
  return std::bit_cast<float>(static_cast<uint32_t>(ref >> 4) << 16);
}

/// Boxes are relative to WideTree::center, rounded outward; those of missing children are empty (lo = infinity,
/// hi = -infinity).
struct alignas(256) WideNode {
  float lower[3][kWidth], upper[3][kWidth];
  ChildRef child[kWidth];
};
static_assert(sizeof(WideNode) == 256);

/// Ids among the floats of a leaf. Lanes that a leaf lacks read them for numbers: as floats about 1, for arithmetic
/// with denormal ones takes ages.
inline constexpr uint32_t kIdMask = 0x3f800000;
inline float stored_id(uint32_t id) {
  return std::bit_cast<float>(id ^ kIdMask);
}
inline uint32_t id_of(float stored) {
  return std::bit_cast<uint32_t>(stored) ^ kIdMask;
}

/// Up to eight triangles in the mesh's own coordinates: count floats for each corner and axis, then count ids. Kernels
/// read eight floats wherever they are, so some bytes must follow (kLeafSlack).
struct WideLeaf {
  const std::byte* bytes;
  uint32_t count;

  const float* corner(size_t c, size_t axis) const {
    return reinterpret_cast<const float*>(bytes) + (3 * c + axis) * count;
  }
  Vec3 vertex(size_t c, size_t lane) const { return {corner(c, 0)[lane], corner(c, 1)[lane], corner(c, 2)[lane]}; }
  uint32_t id(size_t lane) const { return id_of(corner(3, 0)[lane]); }
};
inline constexpr size_t kTriangleBytes = 10 * sizeof(float);
inline constexpr size_t kLeafSlack = 64;

struct FreeLines {
  size_t mapped = 0;  // bytes of a mapping of its own; 0: from the heap
  void operator()(std::byte* bytes) const;
};

/// Whole cache lines, on huge pages where the system has them.
class LineMemory {
 public:
  LineMemory() = default;
  explicit LineMemory(size_t bytes);

  std::byte* data() const { return bytes_.get(); }
  size_t size() const { return size_; }

 private:
  std::unique_ptr<std::byte, FreeLines> bytes_;
  size_t size_ = 0;
};

/// Deepest way of nodes below the root: that of the binary tree, and the halving of leaves with up to 2^32 triangles.
inline constexpr size_t kMaxWideLevels = kMaxTreeLevels + 32;
/// A visit takes one entry off and puts at most eight on.
inline constexpr size_t kWideStackSize = (kWidth - 1) * kMaxWideLevels + kWidth;

struct WideTree {
  LineMemory memory;
  Vec3 center;      // of the scene
  float reach = 0;  // no box goes further from the center along any axis
  size_t nodes = 0, leaves = 0;

  bool is_empty() const { return nodes == 0; }
  const WideNode& node(ChildRef ref) const { return *reinterpret_cast<const WideNode*>(memory.data() + (ref >> 20)); }
  WideLeaf leaf(ChildRef ref) const { return {memory.data() + (ref >> 20), triangles_of(ref)}; }
};

/// The wide tree of least expected cost that has the binary tree's boxes, after Ylitie et al., "Efficient incoherent
/// ray traversal on GPUs through compressed wide BVHs" (2017), section 4.1, under any measure.
WideTree collapse(const Bvh& tree, const TriangleMesh& mesh, const WideOptions& options);

}  // namespace raygrain
