// Which depth several triangles that share edges certainly cover together.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "trace/coverage_squares.h"

namespace raygrain {

/// Finds connected parts of surfaces whose borders and folds stay outside a cell. Scratch space for one thread.
class SheetFinder {
 public:
  explicit SheetFinder(const MeshNeighbours& neighbours) : neighbours_(neighbours), places_(neighbours.size()) {}

  /// Tells of which triangles the cells to come are.
  void enter(std::span<const uint32_t> ids, std::span<const SeenTriangle> tile);
  /// The greatest depth up to which the cell is covered: -infinity for none. `list` holds all triangles that the cell
  /// may meet.
  float cover(std::span<const InCell> list, const CellSquare& cell);

 private:
  /// Beyond this many triangles in a cell only single ones are looked at.
  static constexpr size_t kMostTriangles = 256;

  /// Of a triangle in the tile that it was seen in last.
  struct Place {
    uint32_t tile = 0, slot = 0;
  };
  /// By slots. Of cell `cell` alone.
  struct Part {
    uint32_t cell = 0, parent = 0;
    bool is_open = false;  // an edge in the cell has no or no known other side, parity is not clear, or all is in vain
    bool is_odd = false;   // covers the sample point an odd number of times
    float lowest = 0;
  };

  uint32_t root(uint32_t i);
  bool begin_parts(std::span<const InCell> list, float least);
  bool join_neighbours(std::span<const InCell> list);
  void find_parity(std::span<const InCell> list, const CellSquare& cell);

  std::span<const std::array<uint32_t, 3>> neighbours_;
  std::vector<Place> places_;  // of all triangles
  uint32_t tile_number_ = 0, cell_number_ = 0;
  // Of the tile at hand.
  std::span<const SeenTriangle> tile_;
  std::vector<std::array<uint32_t, 3>> beside_;  // slots of neighbours, or kNoNeighbour
  std::vector<Part> parts_;
};

}  // namespace raygrain
