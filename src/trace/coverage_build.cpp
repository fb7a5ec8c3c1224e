// From a mesh and an area to the grid: tiles of about equal numbers of triangles' places, each cut into as many cells
// as it has use for.
#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>

#include "raygrain/error.h"

#include "base/parallel.h"
#include "trace/coverage_rows.h"
#include "trace/coverage_window.h"

namespace raygrain {
namespace {

/// As many builders as threads need at once.
class RowBuilders {
 public:
  RowBuilders(CoverageGrid& grid, const TileMembers& members, const CoverageDensity& density,
              const MeshNeighbours& neighbours)
      : grid_(grid), members_(members), density_(density), neighbours_(neighbours) {}

  std::unique_ptr<RowBuilder> take() {
    const std::lock_guard lock(mutex_);
    if (unused_.empty()) return std::make_unique<RowBuilder>(grid_, members_, density_, neighbours_, entries_);
    std::unique_ptr<RowBuilder> builder = std::move(unused_.back());
    unused_.pop_back();
    return builder;
  }
  void give_back(std::unique_ptr<RowBuilder> builder) {
    const std::lock_guard lock(mutex_);
    unused_.push_back(std::move(builder));
  }
  bool gave_up() const { return members_.is_too_much(entries_); }

 private:
  CoverageGrid& grid_;
  const TileMembers& members_;
  const CoverageDensity& density_;
  const MeshNeighbours& neighbours_;
  std::atomic<uint64_t> entries_ = 0;  // of all cells so far
  std::mutex mutex_;
  std::vector<std::unique_ptr<RowBuilder>> unused_;
};

/// Puts rows together, and numbers the triangles that cells refer to in the order of their first mention.
void gather(std::vector<CoverageRow>& rows, CoverageGrid& grid) {
  std::vector<uint32_t> number(grid.mesh->triangle_count(), kNoTriangle);
  size_t cells = 0, references = 0, triangles = 0;
  for (const CoverageRow& row : rows) {
    cells += row.cells.size(), references += row.references.size();
    for (const CoverageTriangle& record : row.records) triangles += std::exchange(number[record.id], 0) != 0;
  }
  if (references > 0xffffffffu || cells > 0xffffffffu)
    throw Error(ErrorCode::kLimit, "coverage", "more than 2^32 cells or references");
  std::fill(number.begin(), number.end(), kNoTriangle);
  grid.allocate(triangles, cells + 1, references);
  uint32_t tile = 0, cell_number = 0, reference_number = 0, known_number = 0;
  for (CoverageRow& row : rows) {
    uint32_t first_cell = cell_number;
    for (uint32_t x = 0; x < grid.tiles_x; ++x, ++tile) {
      grid.tiles[tile].first_cell = first_cell;
      first_cell += grid.tiles[tile].across * grid.tiles[tile].across;
    }
    const uint32_t first = reference_number;
    for (const CoverageRow::Reference& reference : row.references) {
      const CoverageTriangle& record = row.records[reference.record];
      uint32_t& known = number[record.id];
      if (known == kNoTriangle) grid.triangles[known = known_number++] = record;
      grid.references[reference_number++] = {static_cast<uint16_t>(known), static_cast<uint16_t>(known >> 16),
                                             reference.code};
    }
    for (CoverageCell cell : row.cells) {
      cell.first += first;
      if (cell.first < reference_number) cell.top = grid.references[cell.first].triangle();
      grid.cells[cell_number++] = cell;
    }
    row = {};
  }
  grid.cells[cell_number] = {0, 0, reference_number};
}

void build_cells(CoverageGrid& grid, const TileMembers& members, const CoverageDensity& density,
                 const MeshNeighbours& neighbours, unsigned threads) {
  RowBuilders builders(grid, members, density, neighbours);
  std::vector<CoverageRow> rows(grid.tiles_y);
  parallel_for(grid.tiles_y, 1, threads, [&](size_t begin, size_t end) {
    std::unique_ptr<RowBuilder> builder = builders.take();
    for (size_t y = begin; y < end; ++y) builder->build(static_cast<uint32_t>(y), rows[y]);
    builders.give_back(std::move(builder));
  });
  if (builders.gave_up()) return grid.tiles.clear();
  gather(rows, grid);
}

}  // namespace

CoverageGrid build_coverage(std::shared_ptr<const TriangleMesh> mesh, const AreaGeometry& area,
                            const CoverageDensity& density, const MeshNeighbours* neighbours, unsigned threads) {
  CoverageGrid grid;
  grid.mesh = std::move(mesh);
  const std::optional<double> near_z = set_window(grid, area);
  if (!near_z) return grid;
  const std::optional<TileMembers> members = find_tile_members(grid, *near_z, density, threads);
  if (!members) return grid;
  if (neighbours != nullptr)
    build_cells(grid, *members, density, *neighbours, threads);
  else
    build_cells(grid, *members, density, find_neighbours(*grid.mesh), threads);
  return grid;
}

}  // namespace raygrain
