// Primitives of one node counted into the slices between candidate planes along one axis, and the best of those planes.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "raygrain/bounds.h"

#include "build/strategy.h"

namespace raygrain::builder {

/// A way to split a node in two. Primitives with key < position go left.
struct Choice {
  const ActiveStrategy* by = nullptr;  // whose partition rule and prices these are; null for no choice
  int axis = 0;
  float quality = 0, position = 0;
  bool halves = false;  // cut the list in two halves, whatever the keys
  Bounds left, right;
  uint32_t left_count = 0;
  float left_measure = 0, right_measure = 0;
  double cost = kNoCost;

  static constexpr double kNoCost = std::numeric_limits<double>::infinity();
  explicit operator bool() const { return by != nullptr; }
};

/// Which of two planes of equal cost is chosen.
enum class Tie {
  kLowerPlane,  // as Algorithm 1; but of planes that cost nothing the more even one, or long chains would come of them
  kMoreEven,    // the one with the more even counts: a measure that sees no difference gives a balanced tree
};

/// Planes and slices along one axis. Keeps its memory for the next node.
class AxisBins {
 public:
  /// `bins` equal slices of [lo, hi], i.e. bins - 1 planes; computed in double, since hi - lo may overflow float.
  void set_equal_slices(float lo, float hi, uint32_t bins);

  /// The same, and a plane at `hi` that separates the topmost keys from the others even where slices are too thin for
  /// float32.
  void set_equal_slices_with_top(float lo, float hi, uint32_t bins);

  /// Planes of any spacing, ascending: fill `planes()`, then call this.
  void use_planes();
  std::vector<float>& planes() { return planes_; }

  void add(float key, const Bounds& box) {
    Slice& slice = slices_[slice_of(key)];
    slice.box.extend(box);
    ++slice.count;
  }

  /// The plane of least cost that leaves no side empty, priced by `strategy` in one batch; no choice if there is none.
  Choice best_plane(const ActiveStrategy& strategy, const NodeContext& node, AxisChoice axis, Tie tie);

 private:
  struct Slice {
    Bounds box;
    uint32_t count = 0;
  };
  struct Candidate {
    uint32_t plane, left_count;
  };

  /// The number of planes at or below the key. A guess that equal slices make exact but for rounding, then corrected.
  size_t slice_of(float key) const {
    if (scale_ < 0) return search_slice(key);
    const double guess = (static_cast<double>(key) - lo_) * scale_;
    size_t slice = 0;
    if (guess > 0) slice = guess < static_cast<double>(planes_.size()) ? static_cast<size_t>(guess) : planes_.size();
    while (slice < planes_.size() && planes_[slice] <= key) ++slice;
    while (slice > 0 && key < planes_[slice - 1]) --slice;
    return slice;
  }
  size_t search_slice(float key) const;
  void clear_slices();
  void sweep();
  bool is_better(const Candidate& candidate, double cost, const Choice& best, uint32_t count, Tie tie) const;

  std::vector<float> planes_;
  std::vector<Slice> slices_;
  double lo_ = 0, scale_ = -1;  // slices per unit; negative: planes are not evenly spaced
  // Scratch of best_plane: one candidate per separating plane; boxes are all left ones, then all right ones.
  std::vector<Candidate> candidates_;
  std::vector<Bounds> boxes_, suffixes_;
  std::vector<float> measures_;
};

}  // namespace raygrain::builder
