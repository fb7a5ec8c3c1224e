#include "trace/coverage_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/sort_few.h"

namespace raygrain {

namespace {

float code(const CoverageTile& tile, float s) {
  return (s - tile.lowest) * tile.per_depth + kFirstCode;
}

}  // namespace

void RowBuilder::build(uint32_t y, CoverageRow& row) {
  const size_t tile = size_t{y} * grid_.tiles_x;
  row.records.reserve(members_.begin[tile + grid_.tiles_x] - members_.begin[tile]);
  for (uint32_t x = 0; x < grid_.tiles_x; ++x) build_tile(x, y, row);
}

void RowBuilder::build_tile(uint32_t tile_x, uint32_t tile_y, CoverageRow& row) {
  const size_t number = size_t{tile_y} * grid_.tiles_x + tile_x;
  const std::span<const uint32_t> ids = members_.of(number);
  CoverageTile& tile = grid_.tiles[number];
  const double wanted = std::sqrt(density_.cells_per_triangle * static_cast<double>(ids.size()));
  tile.across = static_cast<uint32_t>(std::clamp(std::ceil(wanted), 1.0, static_cast<double>(kMostCellsAcross)));
  const Raster raster{grid_.x_lo + tile_x * members_.edge, grid_.y_lo + tile_y * members_.edge,
                      members_.edge / tile.across, tile.across};
  if (!list_entries(raster, ids)) return;
  const size_t cells = size_t{tile.across} * tile.across;
  sort_entries(cells);
  sheets_.enter(ids, seen_);
  covers_.resize(cells);
  for (size_t i = 0; i < cells; ++i) {
    covers_[i] = sheets_.cover(
        list(i), raster.square(static_cast<uint32_t>(i) % tile.across, static_cast<uint32_t>(i) / tile.across));
    drop_hidden(i);
  }
  set_codes(tile);
  record_.assign(ids.size(), kNoTriangle);
  for (size_t i = 0; i < cells; ++i) write_cell(tile, i, row);
}

/// Which triangles each cell may meet, triangle by triangle. False where they are too many.
bool RowBuilder::list_entries(const Raster& raster, std::span<const uint32_t> ids) {
  seen_.resize(std::max(seen_.size(), ids.size()));
  entries_of_tile_.clear();
  const uint64_t others = entries_;
  uint32_t slot = 0;
  for (; slot < ids.size() && !members_.is_too_much(others + entries_of_tile_.size()); ++slot) {
    look_at(grid_, members_.near_z, ids[slot], seen_[slot]);
    list_cells(raster, slot);
  }
  entries_ += entries_of_tile_.size();
  return slot == ids.size();
}

void RowBuilder::list_cells(const Raster& raster, uint32_t slot) {
  const SeenTriangle& one = seen_[slot];
  const WindowPlace place = place_of(one);
  const CellRange columns = cells_of(place.x_lo, place.x_hi, raster.x, raster.width, raster.across);
  const CellRange lines = cells_of(place.y_lo, place.y_hi, raster.y, raster.width, raster.across);
  const SquareTests tests(one, raster.width / 2);
  InCell entry;
  entry.slot = slot;
  for (uint32_t x = columns.lo; x <= columns.hi; ++x) near_x_[x] = tests.edges_near_x(raster.square(x, 0).x);
  uint32_t first = columns.lo;  // that is met: hardly another one in the next line
  for (uint32_t y = lines.lo; y <= lines.hi; ++y) {
    const double cell_y = raster.square(0, y).y;
    const unsigned near_y = tests.edges_near_y(cell_y);
    while (first > columns.lo && tests.goes_on_at(raster.square(first - 1, y).x, cell_y)) --first;
    bool is_met = false;
    for (uint32_t x = first; x <= columns.hi; ++x) {
      if (!tests.meet(raster.square(x, y).x, cell_y, near_x_[x] & near_y, entry)) {
        if (is_met) break;
        continue;
      }
      if (!is_met) first = x;
      is_met = true;
      entry.cell = static_cast<uint16_t>(y * raster.across + x);
      entries_of_tile_.push_back(entry);
    }
  }
}

/// Keeps the order within each cell.
void RowBuilder::sort_entries(size_t cells) {
  begin_.assign(cells + 1, 0);
  for (const InCell& entry : entries_of_tile_) ++begin_[entry.cell + 1];
  for (size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  end_.assign(begin_.begin(), begin_.end() - 1);
  sorted_.resize(std::max(sorted_.size(), entries_of_tile_.size()));
  for (const InCell& entry : entries_of_tile_) sorted_[end_[entry.cell]++] = entry;
}

/// Room for the errors of depths of about this size, and of their codes.
float RowBuilder::slack(float s) const {
  return static_cast<float>(2 * grid_.errors.depth_error(s));
}

/// Codes of the depths that matter in the tile.
void RowBuilder::set_codes(CoverageTile& tile) {
  float lo = kInf, hi = -kInf;
  for (size_t i = 0; i < covers_.size(); ++i)
    for (const InCell& one : list(i)) {
      const float cover = covers_[i];
      if (one.highest < cover) continue;
      hi = std::max(hi, one.highest);
      lo = std::min(lo, cover > -kInf ? cover : one.highest);
    }
  if (!(lo <= hi)) return;
  const float least_step = std::max(slack(lo), slack(hi));
  const float step = std::max({(hi - lo) / (kLastCode - kFirstCode), least_step, std::numeric_limits<float>::min()});
  tile.lowest = lo;
  tile.per_depth = 1 / step;
}

uint16_t RowBuilder::code_above(const CoverageTile& tile, float s) const {
  const float exact = code(tile, s + slack(s));
  if (!(exact > -1)) return 1;
  if (exact > 65533) return 65535;
  const auto whole = static_cast<int32_t>(exact);  // rounded to zero
  return static_cast<uint16_t>(whole + 2 + (static_cast<float>(whole) < exact ? 1 : 0));
}

uint16_t RowBuilder::code_below(const CoverageTile& tile, float s) const {
  return static_cast<uint16_t>(std::clamp(std::floor(code(tile, s - slack(s))) - 2, 0.0f, 65535.0f));
}

/// What lies wholly behind the cover, with room for ties, is nobody's first hit.
void RowBuilder::drop_hidden(size_t cell) {
  const float cover = covers_[cell];
  if (!(cover > -kInf)) return;
  const float behind = cover - 4 * slack(cover) - static_cast<float>(grid_.errors.depth * 8);
  uint32_t end = begin_[cell];
  for (const InCell& one : list(cell)) {
    sorted_[end] = one;
    end += one.highest < behind ? 0 : 1;
  }
  end_[cell] = end;
}

void RowBuilder::write_cell(CoverageTile tile, size_t number, CoverageRow& row) {
  const std::span<InCell> meets = list(number);
  CoverageCell cell;
  cell.first = static_cast<uint32_t>(row.references.size());
  if (covers_[number] > -kInf) cell.cover = code_below(tile, covers_[number]);
  // Nearest to the light first, then by slots, which are in the order of ids.
  sort_few(meets, [](const InCell& a, const InCell& b) { return a.highest > b.highest; });
  if (!meets.empty()) cell.far = code_above(tile, meets.front().highest);
  row.references.resize(row.references.size() + meets.size());
  CoverageRow::Reference* reference = row.references.data() + cell.first;
  for (const InCell& one : meets) {
    uint32_t& record = record_[one.slot];
    if (record == kNoTriangle) {
      record = static_cast<uint32_t>(row.records.size());
      row.records.push_back(seen_[one.slot].record);
    }
    *reference++ = {record, code_above(tile, one.highest)};
  }
  row.cells.push_back(cell);
}

}  // namespace raygrain
