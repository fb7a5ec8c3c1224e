// From a mesh and an area to the grid: tiles of about equal numbers of triangles' places, each cut into as many cells
// as it has use for.
#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>
#include <vector>

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

/// Numbers the triangles that cells refer to in the order of their first mention: for each row, the numbers of its
/// records. Returns their count.
uint32_t number_triangles(const std::vector<CoverageRow>& rows, size_t mesh_triangles,
                          std::vector<std::vector<uint32_t>>& numbers) {
  std::vector<uint32_t> number_of(mesh_triangles, kNoTriangle);
  uint32_t count = 0;
  for (const CoverageRow& row : rows) {
    std::vector<uint32_t>& known = numbers.emplace_back();
    known.reserve(row.records.size());
    for (const CoverageTriangle& record : row.records) {
      uint32_t& number = number_of[record.id];
      if (number == kNoTriangle) number = count++;
      known.push_back(number);
    }
  }
  return count;
}

/// Puts rows together.
void gather(std::vector<CoverageRow>& rows, CoverageGrid& grid) {
  size_t cells = 0, references = 0;
  for (const CoverageRow& row : rows) cells += row.cells.size(), references += row.references.size();
  if (references > 0xffffffffu || cells > 0xffffffffu)
    throw Error(ErrorCode::kLimit, "coverage", "more than 2^32 cells or references");
  std::vector<std::vector<uint32_t>> numbers;
  grid.allocate(number_triangles(rows, grid.mesh->triangle_count(), numbers), cells + 1, references);
  uint32_t tile = 0, cell_number = 0, reference_number = 0, triangle_number = 0;
  for (size_t y = 0; y < rows.size(); ++y) {
    CoverageRow& row = rows[y];
    uint32_t first_cell = cell_number;
    for (uint32_t x = 0; x < grid.tiles_x; ++x, ++tile) {
      grid.tiles[tile].first_cell = first_cell;
      first_cell += grid.tiles[tile].across * grid.tiles[tile].across;
    }
    for (size_t i = 0; i < row.records.size(); ++i)
      if (numbers[y][i] == triangle_number) grid.triangles[triangle_number++] = row.records[i];
    const uint32_t first = reference_number;
    for (const CoverageRow::Reference& reference : row.references) {
      const uint32_t number = numbers[y][reference.record];
      grid.references[reference_number++] = {static_cast<uint16_t>(number), static_cast<uint16_t>(number >> 16),
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
