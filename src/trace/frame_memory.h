// The memory of a wide tree in ray space, and rays prepared for it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "raygrain/frame_tree.h"

#include "trace/wide_tree.h"

namespace raygrain {

/// Children of a node and triangles of a leaf, at most.
inline constexpr size_t kFrameWidth = 16;

/// A child: bits 0-4: triangles (0 = a node), 5-31: offset in units of 64 bytes. 0 stands for no child.
using FrameRef = uint32_t;
inline constexpr FrameRef kNoFrameRef = 0xffffffffu;
inline constexpr size_t kFrameUnit = 64;
inline constexpr uint64_t kMostFrameBytes = uint64_t{kFrameUnit} << 27;

inline FrameRef frame_ref(uint64_t offset, size_t count) {
  return static_cast<FrameRef>(offset / kFrameUnit) << 5 | static_cast<FrameRef>(count);
}
inline size_t triangles_of(FrameRef ref) {
  return ref & 31;
}

/// A visit takes one entry off and puts at most sixteen on; whole vectors are written.
inline constexpr size_t kFrameStackSize = (kFrameWidth - 1) * kMaxWideLevels + 2 * kFrameWidth;

/// Boxes in the frame, rounded outward, farther ones first (by the least z); those of missing children are empty (lo =
/// infinity, hi = -infinity).
struct alignas(64) FrameNode {
  float lower[3][kFrameWidth], upper[3][kFrameWidth];
  FrameRef child[kFrameWidth];
};
static_assert(sizeof(FrameNode) == 448);

/// Up to sixteen triangles: middle and half extent of the leaf's depths, then `count` floats of each field, then count
/// ids. Kernels read sixteen floats wherever they are.
struct FrameLeaf {
  enum Field : size_t { kEdges = 0, kP = 9, kQ = 10, kR = 11, kError = 12, kId = 13, kFields = 14 };
  const std::byte* bytes;
  size_t count;

  const float* floats() const { return reinterpret_cast<const float*>(bytes); }
  float middle() const { return floats()[0]; }
  float half() const { return floats()[1]; }
  const float* field(size_t index) const { return floats() + 2 + index * count; }
  uint32_t id(size_t lane) const { return id_of(field(kId)[lane]); }

  static size_t size(size_t count) {
    const size_t bytes = (2 + kFields * count) * sizeof(float);
    return (bytes + kFrameUnit - 1) / kFrameUnit * kFrameUnit;
  }
};

struct FrameMemory {
  RayFrame frame;
  std::shared_ptr<const TriangleCorners> corners;
  LineMemory memory;
  Bounds bounds;
  std::array<float, 2> depths{};           // a little more than the bounds': what rays are followed through
  double middle = 0, half = 0, depth = 0;  // of these depths, and the largest magnitude of them
  double farthest = 0;                     // no local z of the tree is greater in magnitude
  double least_slope = 0;                  // of cones: less counts as this
  double width = 0;                        // no |x| or |y| of the bounds is greater
  double reach = 0;                        // for edges and planes
  float edge_error = 0;                    // of edge functions in float
  size_t nodes = 0, leaves = 0;

  bool is_empty() const { return nodes == 0; }
  const std::byte* at(FrameRef ref) const { return memory.data() + static_cast<size_t>(ref >> 5) * kFrameUnit; }
  const FrameNode& node(FrameRef ref) const { return *reinterpret_cast<const FrameNode*>(at(ref)); }
  FrameLeaf leaf(FrameRef ref) const { return {at(ref), triangles_of(ref)}; }
};

/// A ray prepared for the kernels; errors are allowed for (docs/theory-frames.md, section "Columns" and "Cones").
struct FrameQuery {
  FrameColumn column;  // for cones too, with its z only
  float tie_constant, tie_linear, tie_square;

  float x0, y0, slope_x, slope_y;      // cones: x = x0 + slope_x z
  float error;                         // of these, at every depth
  float inverse_x, inverse_y;          // z = side * inverse + offset
  float near_x, far_x, near_y, far_y;  // offsets

  double origin_z, speed_z;          // local z of the point at t: origin_z + t speed_z
  double origin_error, speed_error;  // of these two
  bool is_projective;

  /// At or beyond (before, where t falls with z) the returned depth no hit matters, given one between depths lo and hi.
  float bound_after(float lo, float hi) const {
    const float z = column.ascending ? hi : lo, size = z < 0 ? -z : z;
    const float tie = tie_constant + size * tie_linear + z * z * tie_square + size * 0x1p-22f;
    return column.ascending ? z + tie : z - tie;
  }
  /// The same, given a hit's t. What its leaf knows of its depth says nothing: a leaf that holds another part of the
  /// triangle may have found it.
  float bound_at(float t) const {
    const double along = static_cast<double>(t), slack = origin_error + (along < 0 ? -along : along) * speed_error;
    double z = origin_z + along * speed_z + (column.ascending ? slack : -slack);
    if (is_projective) {
      if (!(z > 0)) return column.ascending ? kInf : -kInf;
      z = -1 / z;
    }
    return bound_after(static_cast<float>(z), static_cast<float>(z));
  }
};

/// kUnfit; or kColumn or kCone with the query prepared, whose column.box is empty where there is nothing to search.
FrameUse prepare(const FrameMemory& tree, const Ray& ray, FrameQuery& query);

/// The tree in memory.
FrameMemory write_frame_tree(const RayFrame& frame, const Bvh& tree, std::shared_ptr<const TriangleCorners> corners,
                             const WideOptions& options);

}  // namespace raygrain
