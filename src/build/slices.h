// References of one node counted into slices of their keys' box along up to three axes at once, and the best plane.
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
  SliceGrid(const PackedBox& keys, uint32_t count);
};

/// Counts and boxes per axis and slice; one per chunk of references. Keeps its memory.
class Slices {
 public:
  void clear(uint32_t slices);
  void add(const SliceGrid& grid, std::span<const Reference> references);
  void merge(const Slices& other);

  /// The cheapest plane of the axes in `order`; no cut when none leaves both sides filled. Of planes of equal cost the
  /// one with the most even counts, then the first.
  Cut best_cut(const ActiveStrategy& strategy, const NodeContext& node, const AxisOrder& order, const SliceGrid& grid);

 private:
  struct Candidate {
    uint32_t choice, slice, left_count;
  };
  void sweep(const AxisChoice& axis, uint32_t choice, uint32_t total);

  uint32_t slices_ = 0;
  std::vector<PackedBox> boxes_;  // axis-major
  std::vector<uint32_t> counts_;
  std::vector<Candidate> candidates_;
  std::vector<Bounds> sides_;  // left, right of each candidate
  std::vector<float> measures_;
};

}  // namespace raygrain::builder
