#include "trace/coverage_sheets.h"

#include <algorithm>
#include <limits>

namespace raygrain {
namespace {

constexpr float kNone = -std::numeric_limits<float>::infinity();

}  // namespace

uint32_t SheetFinder::root(uint32_t i) {
  while (parts_[i].parent != i) i = parts_[i].parent = parts_[parts_[i].parent].parent;
  return i;
}

/// Unites triangles across the edges that the cell may meet.
void SheetFinder::join_neighbours(std::span<const SeenTriangle> tile, std::span<const InCell> list,
                                  const CellSquare& cell) {
  ++cell_number_;
  for (uint32_t i = 0; i < list.size(); ++i) {
    const uint32_t id = tile[list[i].slot].record.id;
    slot_of_[id] = i;
    seen_in_[id] = cell_number_;
    parts_[i] = {i, false, false, list[i].lowest};
  }
  for (uint32_t i = 0; i < list.size(); ++i) {
    const SeenTriangle& seen = tile[list[i].slot];
    for (size_t e = 0; e < 3; ++e) {
      if (!seen.edge_may_touch(e, cell.x, cell.y, cell.half)) continue;
      const uint32_t other = neighbours_[seen.record.id][e];
      if (other == kNoNeighbour || seen_in_[other] != cell_number_)
        parts_[i].is_open = true;
      else
        parts_[root(i)].parent = root(slot_of_[other]);
    }
  }
}

/// How often each part covers one point of the cell, which stands for all of them.
void SheetFinder::find_parity(std::span<const SeenTriangle> tile, std::span<const InCell> list,
                              const CellSquare& cell) {
  const double x = cell.x + 0.31 * cell.half, y = cell.y + 0.17 * cell.half;  // off the lines of regular models
  for (uint32_t i = 0; i < list.size(); ++i) {
    Part& part = parts_[root(i)];
    if (part.is_open) continue;
    const SeenTriangle& seen = tile[list[i].slot];
    if (seen.fills(x, y, 0))
      part.is_odd = !part.is_odd;
    else if (seen.may_touch(x, y, 0))
      part.is_open = true;
  }
}

float SheetFinder::cover(std::span<const SeenTriangle> tile, std::span<const InCell> list, const CellSquare& cell) {
  float best = kNone;
  for (const InCell& one : list)
    if (one.lowest > best && tile[one.slot].fills(cell.x, cell.y, cell.half)) best = one.lowest;
  if (list.size() < 2 || list.size() > kMostTriangles) return best;
  parts_.resize(list.size());
  join_neighbours(tile, list, cell);
  for (uint32_t i = 0; i < list.size(); ++i) {
    Part& part = parts_[root(i)];
    part.is_open |= parts_[i].is_open;
    part.lowest = std::min(part.lowest, list[i].lowest);
  }
  find_parity(tile, list, cell);
  for (uint32_t i = 0; i < list.size(); ++i)
    if (const Part& part = parts_[i]; part.parent == i && !part.is_open && part.is_odd)
      best = std::max(best, part.lowest);
  return best;
}

}  // namespace raygrain
