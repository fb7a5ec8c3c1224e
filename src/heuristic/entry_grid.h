// How many rays enter a box, asked of a grid in constant time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "raygrain/bounds.h"
#include "raygrain/ray.h"

namespace raygrain {

/// A ray enters a convex box once: it starts inside, or crosses a face inwards. So the rays that enter a box of whole
/// cells are counted by their starts in it and their crossings through its faces, both from summed tables after Crow,
/// "Summed-area tables for texture mapping" (1984).
class EntryGrid {
 public:
  /// Of all sample rays as if nothing stopped them, and of those that are alive there: on the way from tmin to tmax.
  struct Counts {
    uint32_t all = 0, alive = 0;

    Counts& operator+=(Counts other) {
      all += other.all;
      alive += other.alive;
      return *this;
    }
    /// Differences of sums may pass below zero on the way.
    Counts& operator-=(Counts other) {
      all -= other.all;
      alive -= other.alive;
      return *this;
    }
  };

  explicit EntryGrid(std::span<const Ray> rays);

  /// Does any ray end?
  bool has_ends() const { return has_ends_; }

  /// All cells: where rays start and end, and a rim of one cell for whatever lies beyond.
  const Bounds& box() const { return box_; }

  /// Of the least box of whole cells that holds `box`.
  Counts entering(const Bounds& box) const;

 private:
  using Place = std::array<size_t, 3>;  // of a cell, or of a corner between cells

  void add_rim();
  size_t cell_of(double x, int axis) const;
  void follow(const Ray& ray);
  void sum_up();
  Counts starting(const Place& lo, const Place& hi) const;
  Counts crossing(int axis, bool ascending, size_t plane, const Place& lo, const Place& hi) const;

  Bounds box_;
  bool has_ends_ = false;
  std::vector<Counts> starts_;                                 // below each corner
  std::array<std::array<std::vector<Counts>, 2>, 3> crossed_;  // by axis and sense: in each plane, below each corner
};

}  // namespace raygrain
