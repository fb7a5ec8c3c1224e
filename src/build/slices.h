// The planes that may part a node, priced: between slices of the keys' box along up to three axes at once, or between
// any two keys of a small node.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "build/reference.h"
#include "build/strategy.h"

namespace raygrain::builder {

/// How a node is parted in two.
struct Cut {
  enum class Kind { kNone, kKeys, kHalves, kSpace };
  Kind kind = Kind::kNone;
  int axis = 0;
  float quality = 0;
  float lo = 0, scale = 0, limit = 0;  // kKeys: left where (key - lo) * scale < limit
  float plane = 0;                     // kSpace
  Bounds left, right;
  uint32_t left_count = 0, right_count = 0;
  float left_measure = 0, right_measure = 0;
  double cost = std::numeric_limits<double>::infinity();

  explicit operator bool() const { return kind != Kind::kNone; }
};

/// The slices of a node: where they are. Every number is a function of the keys' box alone.
struct SliceGrid {
  FourFloats lo{}, scale{};  // by axis; scale 0: the axis separates nothing
  uint32_t slices = 0;

  SliceGrid() = default;
  SliceGrid(const KeyBox& keys, uint32_t count);
};

/// Planes and what they leave on their sides, of all axes of one node. Keeps its memory.
class CutCandidates {
 public:
  struct Plane {
    uint32_t choice;  // number of the axis in the orientation's order
    float limit;
    uint32_t left_count;
  };

  /// None is left; there is room for so many.
  void clear(size_t room);
  size_t size() const { return size_; }
  void resize(size_t size) { size_ = size; }
  const Plane& plane(size_t candidate) const { return planes_[candidate]; }

  /// Of any candidate that there is room for.
  void set_left(size_t candidate, const Plane& plane, const PackedBox& left) {
    planes_[candidate] = plane;
    sides_[2 * candidate] = left.unpacked();
  }
  void set_right(size_t candidate, const PackedBox& right) { sides_[2 * candidate + 1] = right.unpacked(); }
  void add_left(const Plane& plane, const PackedBox& left) { set_left(size_++, plane, left); }

  /// The cheapest; no cut when there is none. Of planes of equal cost the one with the most even counts, then the
  /// first. Its `lo` and `scale` are the caller's to fill.
  Cut cheapest(const ActiveStrategy& strategy, const NodeContext& node, const AxisOrder& order);

 private:
  size_t size_ = 0;
  std::vector<Plane> planes_;  // no shorter than `size_`; likewise:
  std::vector<Bounds> sides_;  // left, right of each candidate
  std::vector<float> measures_;
  std::vector<double> costs_;
};

/// Counts and boxes per axis and slice; one per chunk of references. Keeps its memory.
class Slices {
 public:
  void clear(uint32_t slices);
  template <class Reference>
  void add(const SliceGrid& grid, std::span<const Reference> references);
  /// The same for one axis alone: in a third of the time.
  template <class Reference>
  void add_along(int axis, const SliceGrid& grid, std::span<const Reference> references);
  void merge(const Slices& other);

  /// References in the slices of an axis below `end`.
  size_t count_below(int axis, uint32_t end) const;

  /// The cheapest plane of the axes in `order`; no cut when none leaves both sides filled.
  Cut best_cut(const ActiveStrategy& strategy, const NodeContext& node, const AxisOrder& order, const SliceGrid& grid,
               CutCandidates& candidates) const;

 private:
  void sweep(int axis, uint32_t choice, CutCandidates& candidates) const;

  uint32_t slices_ = 0;
  std::vector<PackedBox> boxes_;  // axis-major
  std::vector<uint32_t> counts_;
};

/// Nodes of up to this many references are parted at the best plane between any two keys: that takes no longer than
/// slices, and misses nothing.
inline constexpr uint32_t kSmallNode = 8;
template <class Reference>
Cut best_cut_of_small(std::span<const Reference> references, const ActiveStrategy& strategy, const NodeContext& node,
                      const AxisOrder& order, CutCandidates& candidates);

}  // namespace raygrain::builder
