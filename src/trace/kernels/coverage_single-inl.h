// One ray alone and a coverage grid. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_COVERAGE_SINGLE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_COVERAGE_SINGLE_INL_H
#undef RAYGRAIN_TRACE_KERNELS_COVERAGE_SINGLE_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_COVERAGE_SINGLE_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <optional>

#include <hwy/cache_control.h>

#include "trace/kernels/coverage_questions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

/// Is nothing where the column is?
inline bool is_beside(const CoverageGrid& grid, const SingleColumn& c) {
  const bool inside = c.x >= grid.x_lo && c.x <= grid.x_hi && c.y >= grid.y_lo && c.y <= grid.y_hi;
  return grid.is_free_beside && !inside && std::abs(c.x) <= 0x1p60f && std::abs(c.y) <= 0x1p60f;
}

/// The cell of one column; false for columns that are not the grid's.
inline bool find_cell(const CoverageGrid& grid, const SingleColumn& c, uint32_t& tile, uint32_t& cell) {
  if (!(c.x >= grid.x_lo && c.x <= grid.x_hi && c.y >= grid.y_lo && c.y <= grid.y_hi)) return false;
  const float gx = (c.x - grid.x_lo) * grid.tiles_per_unit, gy = (c.y - grid.y_lo) * grid.tiles_per_unit;
  const uint32_t tx = std::min(static_cast<uint32_t>(gx), grid.tiles_x - 1);
  const uint32_t ty = std::min(static_cast<uint32_t>(gy), grid.tiles_y - 1);
  tile = ty * grid.tiles_x + tx;
  cell = cell_at(grid.tiles[tile], gx - static_cast<float>(tx), gy - static_cast<float>(ty));
  return true;
}

inline std::optional<bool> single_any(const CoverageGrid& grid, const SingleColumn& column, const Ray& ray) {
  uint32_t tile = 0, number = 0;
  if (is_beside(grid, column)) return false;
  if (!find_cell(grid, column, tile, number)) return {};
  const CoverageCell* cell = &grid.cells[number];
  fetch_list(grid, *cell);
  if (code_of(grid.tiles[tile], column.end) <= cell->far) return {};
  const uint16_t code = code_of(grid.tiles[tile], column.s);
  if (code < cell->cover) return true;
  if (code > cell->far && grid.near_triangles.empty()) return false;
  const Waiting w{column.x, column.y, column.s, cell->first, cell[1].first - cell->first, 0, tile, code, 0};
  uint64_t tests = 0;
  return meets_any(
      grid, w,
      [&](uint32_t id) {
        Hit hit;
        return confirm(ray, *grid.mesh, id, hit);
      },
      tests);
}

inline std::optional<Hit> single_nearest(const CoverageGrid& grid, const SingleColumn& column, const Ray& ray) {
  uint32_t tile = 0, number = 0;
  if (is_beside(grid, column)) return Hit{};
  if (!find_cell(grid, column, tile, number)) return {};
  const CoverageCell* cell = &grid.cells[number];
  fetch_list(grid, *cell);
  if (code_of(grid.tiles[tile], column.s) <= cell->far && column.s < kInf) return {};
  Hit best;
  const auto consider = [&](uint32_t id) {
    Hit hit;
    if (confirm(ray, *grid.mesh, id, hit) && is_nearer(hit, best)) best = hit;
  };
  for (const uint32_t id : grid.near_triangles) consider(id);
  first_hits(grid, column.x, column.y, {cell->first, cell[1].first - cell->first, tile}, consider);
  return best;
}

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
