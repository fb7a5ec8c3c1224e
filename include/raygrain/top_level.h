// The top level: which influence areas might serve a ray that starts at a point.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "raygrain/bounds.h"
#include "raygrain/region.h"

namespace raygrain {

enum class TopLevelKind { kList, kOctree };

struct TopLevelOptions {
  TopLevelKind kind = TopLevelKind::kOctree;
  uint32_t max_level = 5;  // of the octree; root = level 0; at most 10
};

/// A conservative index over regions: `regions_at(p)` holds every region that contains p, in ascending order, and
/// perhaps more ("false candidates"). Immutable once made.
///
/// The octree (Samet, "An overview of quadtrees, octrees, and related hierarchical data structures", 1988) stops where
/// all regions that overlap a cell enclose it, where none does, or at max_level.
class TopLevel {
 public:
  struct Node {
    Bounds bounds;
    uint32_t first_child = 0;                // of eight; 0 for a leaf
    uint32_t first_region = 0, regions = 0;  // range of the region list, for leaves
  };

  TopLevel() = default;
  TopLevel(std::span<const ConvexRegion> regions, const TopLevelOptions& options);

  /// Indices of the regions that may contain the point; valid as long as this object.
  std::span<const uint32_t> regions_at(Vec3 point) const;

  TopLevelKind kind() const { return kind_; }
  std::span<const Node> nodes() const { return nodes_; }  // empty for a list
  size_t region_count() const { return region_count_; }
  size_t memory_bytes() const;

 private:
  TopLevelKind kind_ = TopLevelKind::kList;
  size_t region_count_ = 0;
  std::vector<Node> nodes_;
  std::vector<uint32_t> region_list_;
};

}  // namespace raygrain
