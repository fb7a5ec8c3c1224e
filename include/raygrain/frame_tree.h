// Wide trees in ray space: rays of one direction or one point as columns, rays near them as cones, one at a time.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "raygrain/build.h"
#include "raygrain/bvh.h"
#include "raygrain/mesh.h"
#include "raygrain/ray.h"
#include "raygrain/ray_frame.h"
#include "raygrain/trace.h"
#include "raygrain/wide.h"

namespace raygrain {

/// The corners of a mesh's triangles, triangle by triangle: 36 bytes each, made once for all trees in ray space.
class TriangleCorners {
 public:
  explicit TriangleCorners(const TriangleMesh& mesh);

  size_t size() const { return corners_.size(); }  // triangles; ids are below it
  const std::array<Vec3, 3>& at_id(uint32_t triangle) const { return corners_[triangle]; }
  size_t memory_bytes() const { return corners_.size() * sizeof(corners_[0]); }

 private:
  std::vector<std::array<Vec3, 3>> corners_;
};

/// How a tree in ray space sees a ray.
enum class FrameUse : uint8_t {
  kUnfit,   // not at all: ask another tree
  kColumn,  // as a column: six compares a node
  kCone,    // as a line near the frame's z axis
};

/// An immutable wide tree over triangles in a ray frame. Cheap to copy (shared inside), safe to use from many threads.
/// Boxes, edges and planes of the frame only filter; intersect_triangle decides. Answers about rays that fit equal
/// those of a search over the tree's triangles, bit for bit, on every instruction set, as far as hits lie in the
/// frame's domain; other hits may be found or not.
class FrameTree {
 public:
  FrameTree();  // empty: every ray misses

  /// Collapses `tree`, built over frame_bounds of triangles: its prims are triangle ids. The same tree gives the same
  /// bytes. Throws Error: kUsage for options out of range, an instruction set that this CPU lacks, no corners, an id
  /// that they do not have, or a tree that reaches beyond 2^30 in the frame or is smaller than 2^-30; kBadHeuristic for
  /// a measure that is negative or not finite; kLimit beyond 2^33 bytes.
  FrameTree(const RayFrame& frame, const Bvh& tree, std::shared_ptr<const TriangleCorners> corners,
            const WideOptions& options = {});

  FrameUse use_of(const Ray& ray) const;

  /// Nearest hit by (t, id), merged with `known`; nothing for rays that do not fit. Invalid rays return `known`.
  std::optional<Hit> intersect(const Ray& ray, Hit known = {}, const SearchOptions& options = {}) const;
  /// Is there any hit in [tmin, tmax]?
  std::optional<bool> occluded(const Ray& ray, const SearchOptions& options = {}) const;

  /// The same with counts of what was done (slower).
  std::optional<Hit> intersect_counted(const Ray& ray, TraceCounters& counters, Hit known = {},
                                       const SearchOptions& options = {}) const;
  std::optional<bool> occluded_counted(const Ray& ray, TraceCounters& counters,
                                       const SearchOptions& options = {}) const;

  const RayFrame& frame() const;
  const Bounds& bounds() const;  // of the tree, in the frame; empty for an empty tree
  Isa isa() const;
  size_t node_count() const;
  size_t leaf_count() const;
  size_t memory_bytes() const;  // nodes and leaves, without the corners
  /// As given, shared by all trees that were made of them; null for an empty tree without any.
  const std::shared_ptr<const TriangleCorners>& corners() const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

/// How dense rays through a point are: what a projective frame's tree is made for.
enum class RayDensity : uint8_t {
  kNearPlane,   // the same everywhere on the near plane, so as many as a box is large in the frame
  kSolidAngle,  // the same for every solid angle, as of an isotropic light: fewer towards the window's corners
};

struct FrameBuildOptions {
  /// Face weights of the measure in the frame; the z term that is added to them, as a share of the xy term of a cube as
  /// wide and high as the scene's image: without it nothing splits along the rays, and the first hit prunes too little.
  Vec3d weights{0, 0, 1};
  float z_term = 0.1f;
  RayDensity density = RayDensity::kNearPlane;  // kSolidAngle: the xy term is the solid angle of the box's xy extent
  bool spatial = true;                          // cut triangles where that pays
  unsigned threads = 0;
  std::optional<Isa> isa = std::nullopt;
};

/// Builds the tree over these triangles (ids), as far as they lie in the frame's domain. Nothing where a tree in
/// this frame cannot be made (see FrameTree). `cost` gets the estimated cost of all rays of the distribution, up to a
/// factor that does not depend on the frame: less is better. Throws Error: kUsage for no corners, an id that they do
/// not have, an instruction set that this CPU lacks, weights or a z term that are negative or not finite, weights.z =
/// 0, weights whose ratio to weights.z is beyond float, and kSolidAngle in a frame that is not projective; kLimit
/// beyond 2^33 bytes.
std::optional<FrameTree> build_frame_tree(const RayFrame& frame, std::shared_ptr<const TriangleCorners> corners,
                                          std::span<const uint32_t> triangles, const FrameBuildOptions& options = {},
                                          double* cost = nullptr);

}  // namespace raygrain
