#include "trace/coverage_sheets.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace raygrain {
namespace {

constexpr float kNone = -std::numeric_limits<float>::infinity();

enum class Side { kOut, kIn, kUnknown };

/// Does a column meet the triangle?
Side side_of(const SeenTriangle& seen, double x, double y) {
  if (!seen.is_clear) return Side::kUnknown;
  bool is_sure = true;
  for (const auto& edge : seen.edges) {
    const double reach = (std::abs(edge[0]) + std::abs(edge[1])) * seen.margin + seen.margin;
    const double at = edge[0] * x + edge[1] * y + edge[2];
    if (at < -reach) return Side::kOut;
    is_sure &= at > reach;
  }
  return is_sure ? Side::kIn : Side::kUnknown;
}

}  // namespace

void SheetFinder::enter(std::span<const uint32_t> ids, std::span<const SeenTriangle> tile) {
  tile_ = tile;
  ++tile_number_;
  for (uint32_t slot = 0; slot < ids.size(); ++slot) places_[ids[slot]] = {tile_number_, slot};
  if (parts_.size() < ids.size()) parts_.resize(ids.size()), beside_.resize(ids.size());
  for (size_t slot = 0; slot < ids.size(); ++slot)
    for (size_t e = 0; e < 3; ++e) {
      const uint32_t other = neighbours_[ids[slot]][e];
      const bool is_here = other != kNoNeighbour && places_[other].tile == tile_number_;
      beside_[slot][e] = is_here ? places_[other].slot : kNoNeighbour;
    }
}

uint32_t SheetFinder::root(uint32_t i) {
  while (parts_[i].parent != i) i = parts_[i].parent = parts_[parts_[i].parent].parent;
  return i;
}

/// Begins with a part for each. Parts with triangles that do not lie above `least` throughout the cell cover no more
/// than that, whatever they are. False where there are no others.
bool SheetFinder::begin_parts(std::span<const InCell> list, float least) {
  ++cell_number_;
  bool any = false;
  for (const InCell& one : list) {
    const bool matters = one.lowest > least;
    any |= matters;
    parts_[one.slot] = {cell_number_, one.slot, !matters, false, one.lowest};
  }
  return any;
}

/// Unites triangles across the edges that the cell may meet, but for those that are known to be open. False where all
/// are.
bool SheetFinder::join_neighbours(std::span<const InCell> list) {
  for (const InCell& one : list) {
    Part& part = parts_[one.slot];
    for (unsigned edges = one.edges; edges != 0; edges &= edges - 1) {
      const uint32_t number = beside_[one.slot][static_cast<size_t>(std::countr_zero(edges))];
      if (number == kNoNeighbour || parts_[number].cell != cell_number_)
        part.is_open = true;
      else if (Part& other = parts_[number]; part.is_open || other.is_open)
        part.is_open = other.is_open = true;
      else
        parts_[root(one.slot)].parent = root(number);
    }
  }
  bool any = false;
  for (const InCell& one : list) {
    Part& own = parts_[one.slot];
    any |= !own.is_open;
    own.parent = root(one.slot);
    Part& part = parts_[own.parent];
    part.is_open |= own.is_open;
    part.lowest = std::min(part.lowest, one.lowest);
  }
  return any;
}

/// How often each part covers one point of the cell, which stands for all of them.
void SheetFinder::find_parity(std::span<const InCell> list, const CellSquare& cell) {
  const double x = cell.x + 0.31 * cell.half, y = cell.y + 0.17 * cell.half;  // off the lines of regular models
  for (const InCell& one : list) {
    Part& part = parts_[parts_[one.slot].parent];
    if (part.is_open) continue;
    const Side side = side_of(tile_[one.slot], x, y);
    part.is_odd ^= side == Side::kIn;
    part.is_open |= side == Side::kUnknown;
  }
}

float SheetFinder::cover(std::span<const InCell> list, const CellSquare& cell) {
  float best = kNone;
  for (const InCell& one : list)
    if (one.is_filled) best = std::max(best, one.lowest);
  if (list.size() < 2 || list.size() > kMostTriangles) return best;
  if (!begin_parts(list, best)) return best;
  if (!join_neighbours(list)) return best;
  find_parity(list, cell);
  for (const InCell& one : list)
    if (const Part& part = parts_[one.slot]; part.parent == one.slot && !part.is_open && part.is_odd)
      best = std::max(best, part.lowest);
  return best;
}

}  // namespace raygrain
