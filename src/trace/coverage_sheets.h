// Which depth several triangles that share edges certainly cover together.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "trace/coverage_triangle.h"

namespace raygrain {

/// A triangle that a cell may meet, with its least and greatest depth there.
struct InCell {
  float highest, lowest;
  uint32_t slot;  // of the tile's triangles
};

/// The middle of a cell and half its width.
struct CellSquare {
  double x, y, half;
};

/// Finds connected parts of surfaces whose borders and folds stay outside a cell. Scratch space for one thread.
class SheetFinder {
 public:
  explicit SheetFinder(const MeshNeighbours& neighbours)
      : neighbours_(neighbours), slot_of_(neighbours.size()), seen_in_(neighbours.size(), 0) {}

  /// The greatest depth up to which the cell is covered: -infinity for none. `list` holds all triangles that the cell
  /// may meet.
  float cover(std::span<const SeenTriangle> tile, std::span<const InCell> list, const CellSquare& cell);

 private:
  /// Beyond this many triangles in a cell only single ones are looked at.
  static constexpr size_t kMostTriangles = 256;

  struct Part {
    uint32_t parent = 0;
    bool is_open = false;  // an edge in the cell has no or no known other side, or parity is not clear
    bool is_odd = false;   // covers the sample point an odd number of times
    float lowest = 0;
  };

  uint32_t root(uint32_t i);
  void join_neighbours(std::span<const SeenTriangle> tile, std::span<const InCell> list, const CellSquare& cell);
  void find_parity(std::span<const SeenTriangle> tile, std::span<const InCell> list, const CellSquare& cell);

  std::span<const std::array<uint32_t, 3>> neighbours_;
  std::vector<uint32_t> slot_of_, seen_in_;
  uint32_t cell_number_ = 0;
  std::vector<Part> parts_;
};

}  // namespace raygrain
