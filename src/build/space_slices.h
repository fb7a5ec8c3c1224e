// Spatial splits after Stich, Friedrich and Dietrich, "Spatial splits in bounding volume hierarchies" (2009): planes
// that cut primitives in two, with any measure in place of the surface area and a callback in place of triangles.
#pragma once

#include <array>
#include <vector>

#include "build/slices.h"

namespace raygrain::builder {

/// Planes at equal distances through a node's box, by axis.
class SpaceGrid {
 public:
  static constexpr uint32_t kSlices = 16;
  static constexpr size_t kPlanes = kSlices - 1;

  explicit SpaceGrid(const Bounds& box);

  float plane(int axis, size_t i) const { return planes_[static_cast<size_t>(axis)][i]; }
  bool has(int axis) const { return scale_[static_cast<size_t>(axis)] > 0; }
  size_t planes_up_to(int axis, float x) const;  // number of planes <= x
  size_t planes_below(int axis, float x) const;  // number of planes < x

 private:
  size_t guess(int axis, float x) const;

  std::array<std::array<float, kPlanes>, 3> planes_{};
  std::array<float, 3> lo_{}, scale_{};
};

/// The parts of references in each slice; one per chunk of references.
class SpaceSlices {
 public:
  void clear();
  void add(const SpaceGrid& grid, const AxisOrder& order, std::span<const Reference> references,
           const ClipPrimitive& clip);
  void merge(const SpaceSlices& other);

  /// The cheapest plane that leaves fewer references than the node has on either side and at most `room` on both
  /// together.
  Cut best_cut(const ActiveStrategy& strategy, const NodeContext& node, const AxisOrder& order, const SpaceGrid& grid,
               uint32_t room);

 private:
  struct Slice {
    PackedBox box;
    uint32_t entries = 0, exits = 0;  // references that begin here, that end here
  };
  struct Candidate {
    AxisChoice axis;
    float plane;
    uint32_t left_count, right_count;
  };
  void sweep(const NodeContext& node, const AxisChoice& axis, const SpaceGrid& grid, uint32_t room);

  std::array<std::array<Slice, SpaceGrid::kSlices>, 3> slices_;
  std::vector<Candidate> candidates_;
  std::vector<Bounds> sides_;
  std::vector<float> measures_;
};

/// The two sides of a spatial cut. A reference that the plane cuts is cut, or goes to one side whole where that is
/// cheaper ("unsplitting"), judged by the sides as they were when the plane was chosen: so no order matters.
void part_by_plane(const Cut& cut, std::span<const Reference> references, const ActiveStrategy& strategy,
                   const NodeContext& node, const ClipPrimitive& clip, std::vector<Reference>& left,
                   std::vector<Reference>& right);

}  // namespace raygrain::builder
