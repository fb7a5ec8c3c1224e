// Spatial splits after Stich, Friedrich and Dietrich, "Spatial splits in bounding volume hierarchies" (2009): planes
// that cut primitives in two, with any measure in place of the surface area and a callback in place of triangles.
//
// The plane is found by cutting boxes, which is cheap and prices no plane too low; primitives themselves are cut at the
// one plane that this finds, and its true price decides.
#pragma once

#include <array>
#include <vector>

#include "build/slices.h"

namespace raygrain::builder {

/// Slices of equal thickness through a node's box, by axis.
struct SpaceGrid {
  static constexpr uint32_t kSlices = 16;

  std::array<float, 3> lo{}, scale{}, step{};  // scale 0: the axis has no length

  explicit SpaceGrid(const Bounds& box);
  float plane(size_t axis, uint32_t below) const { return lo[axis] + step[axis] * static_cast<float>(below); }
};

/// The parts of references' boxes in each slice; one per chunk of references.
class SpaceSlices {
 public:
  void clear();
  template <class Reference>
  void add(const SpaceGrid& grid, std::span<const Reference> references);
  void merge(const SpaceSlices& other);

  /// The cheapest plane that leaves fewer references than the node has on either side. Counts and boxes are estimates
  /// from above.
  Cut best_cut(const ActiveStrategy& strategy, const NodeContext& node, const AxisOrder& order, const SpaceGrid& grid);

 private:
  struct Slice {
    PackedBox box;                    // of whole boxes; not along the slices' own axis. Along that:
    float lo = kInf, hi = -kInf;      // the least of what begins here, the greatest of what ends here
    uint32_t entries = 0, exits = 0;  // references that begin here, that end here
  };
  using AxisSlices = std::array<Slice, SpaceGrid::kSlices>;
  struct Candidate {
    AxisChoice axis;
    float plane;
    uint32_t left_count, right_count;
  };
  void sweep(const NodeContext& node, const AxisChoice& axis, const SpaceGrid& grid);

  static std::array<PackedBox, SpaceGrid::kSlices> boxes_of(const AxisSlices& slices, int axis, const SpaceGrid& grid);

  std::array<AxisSlices, 3> slices_;
  std::vector<Candidate> candidates_;
  std::vector<Bounds> sides_;
  std::vector<float> measures_;
};

/// The references of one chunk on either side of a plane, and those that it cuts.
template <class Reference>
struct SpaceSides {
  struct Torn {
    Reference whole;
    Bounds lower, upper;
  };
  std::vector<Reference> left, right;
  std::vector<Torn> torn;
  PackedBox left_box, right_box;

  /// Sorts references to the sides of the plane and cuts those that it crosses.
  void part(const Cut& plane, std::span<const Reference> references, const ClipPrimitive& clip);

  /// Moves each torn reference to both sides in parts, or whole to one side where that is cheaper ("unsplitting"),
  /// judged by the sides with all parts, as `cut` holds them: so no order matters.
  void mend(const Cut& cut, const ActiveStrategy& strategy, const NodeContext& node);
};

}  // namespace raygrain::builder
