// The tiles of a coverage, and which triangles each of them must know.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/rounding.h"
#include "trace/coverage_triangle.h"

namespace raygrain {

/// Of a triangle in the window, with margins, rounded outward.
struct WindowPlace {
  float x_lo, x_hi, y_lo, y_hi;
};
inline WindowPlace place_of(const SeenTriangle& seen) {
  const double room = 2 * seen.margin;
  return {float_below(seen.x_lo - room), float_above(seen.x_hi + room), float_below(seen.y_lo - room),
          float_above(seen.y_hi + room)};
}

struct CellRange {
  uint32_t lo, hi;
};
/// Cells of this width, `count` of them from `begin` on, that hold [lo, hi].
inline CellRange cells_of(float lo, float hi, double begin, double width, uint32_t count) {
  const auto cell_at = [&](double position) {
    if (!(position > 0)) return 0u;
    return position < count ? static_cast<uint32_t>(position) : count - 1;
  };
  return {cell_at((lo - begin) / width), cell_at((hi - begin) / width)};
}

struct TileMembers {
  double near_z = 0;  // as look_at takes it
  double edge = 1;    // of a tile
  size_t seen = 0;    // triangles in the window
  std::vector<uint32_t> begin, ids;

  std::span<const uint32_t> of(size_t tile) const {
    return std::span(ids).subspan(begin[tile], begin[tile + 1] - begin[tile]);
  }
  /// Where large triangles lie over each other in many layers, cells would list them all: such scenes stay uncovered.
  /// What is counted does not depend on threads, and neither does the verdict: work ends early only where it is
  /// exceeded.
  bool is_too_much(uint64_t entries) const { return entries > 64 * uint64_t{seen} + (uint64_t{1} << 20); }
};

/// Sets the grid's tiles and near triangles. Nothing where there is nothing to see, too much too near, or too much in
/// tiles.
std::optional<TileMembers> find_tile_members(CoverageGrid& grid, double near_z, const CoverageDensity& density,
                                             unsigned threads);

}  // namespace raygrain
