// The cells of one row of tiles.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "trace/coverage_sheets.h"
#include "trace/coverage_tiles.h"

namespace raygrain {

/// Cells of a row of tiles in their order. References name records of the row itself.
struct CoverageRow {
  struct Reference {
    uint32_t record;
    uint16_t code;
  };
  std::vector<CoverageCell> cells;
  std::vector<Reference> references;
  std::vector<CoverageTriangle> records;
};

/// Builds one row after the other; each thread has its own.
class RowBuilder {
 public:
  /// `entries` counts triangles in cells, of all rows: build() gives up where they are too many.
  RowBuilder(CoverageGrid& grid, const TileMembers& members, const CoverageDensity& density,
             const MeshNeighbours& neighbours, std::atomic<uint64_t>& entries)
      : grid_(grid), members_(members), density_(density), entries_(entries), sheets_(neighbours) {}

  /// Row `y` of the grid's tiles; sets these, but for the number of their first cells.
  void build(uint32_t y, CoverageRow& row);

 private:
  static constexpr uint32_t kMostCellsAcross = 128;
  static_assert(kMostCellsAcross * kMostCellsAcross <= 0x10000);  // cells have numbers of 16 bits

  /// Where the tile at hand has its cells.
  struct Raster {
    double x, y, width;
    uint32_t across;

    CellSquare square(uint32_t column, uint32_t line) const {
      return {x + (column + 0.5) * width, y + (line + 0.5) * width, width / 2};
    }
  };

  void build_tile(uint32_t tile_x, uint32_t tile_y, CoverageRow& row);
  bool list_entries(const Raster& raster, std::span<const uint32_t> ids);
  void list_cells(const Raster& raster, uint32_t slot);
  void sort_entries(size_t cells);
  std::span<InCell> list(size_t cell) { return std::span(sorted_).subspan(begin_[cell], end_[cell] - begin_[cell]); }
  float slack(float s) const;
  void set_codes(CoverageTile& tile);
  uint16_t code_above(const CoverageTile& tile, float s) const;
  uint16_t code_below(const CoverageTile& tile, float s) const;
  void drop_hidden(size_t cell);
  void write_cell(CoverageTile tile, size_t number, CoverageRow& row);

  CoverageGrid& grid_;
  const TileMembers& members_;
  const CoverageDensity& density_;
  std::atomic<uint64_t>& entries_;
  // Of the tile at hand.
  SheetFinder sheets_;
  std::vector<SeenTriangle> seen_;
  std::vector<InCell> entries_of_tile_, sorted_;  // by triangle; by cell
  std::vector<uint32_t> begin_, end_;             // of each cell in `sorted_`
  std::vector<uint32_t> record_;                  // of each seen triangle in its row's records
  std::vector<float> covers_;
  std::array<unsigned, kMostCellsAcross> near_x_;  // of the triangle at hand: its edges near each column
};

}  // namespace raygrain
