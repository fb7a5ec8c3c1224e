// From a mesh and an area to the grid: tiles of about equal numbers of triangles' places, each cut into as many cells
// as it has use for.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "raygrain/error.h"

#include "base/parallel.h"
#include "geometry/rounding.h"
#include "trace/coverage_grid.h"
#include "trace/coverage_sheets.h"
#include "trace/coverage_triangle.h"
#include "trace/coverage_window.h"

namespace raygrain {
namespace {

constexpr uint32_t kMostCellsAcross = 128;
constexpr uint32_t kMostTilesAcross = 2048;
constexpr size_t kMostNearTriangles = 16;

/// What one thread needs for one tile after the other.
struct TileScratch {
  struct Entry {
    uint32_t cell;
    InCell one;
  };
  explicit TileScratch(const MeshNeighbours& neighbours) : sheets(neighbours) {}

  SheetFinder sheets;
  std::vector<SeenTriangle> seen;
  std::vector<Entry> entries;
  std::vector<InCell> sorted;           // by cell
  std::vector<uint32_t> begin, record;  // of each cell in `sorted`; of each seen triangle in its row's records
  std::vector<float> covers;

  std::span<InCell> list(size_t cell) { return std::span(sorted).subspan(begin[cell], begin[cell + 1] - begin[cell]); }

  /// Keeps the order within each cell.
  void sort_entries(size_t cells) {
    begin.assign(cells + 1, 0);
    for (const Entry& entry : entries) ++begin[entry.cell + 1];
    for (size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    sorted.resize(entries.size());
    for (const Entry& entry : entries) sorted[begin[entry.cell]++] = entry.one;
    for (size_t i = begin.size() - 1; i > 0; --i) begin[i] = begin[i - 1];
    begin[0] = 0;
  }
};

class Builder {
 public:
  Builder(CoverageGrid& grid, const CoverageDensity& density, const MeshNeighbours* neighbours, unsigned threads)
      : grid_(grid), density_(density), neighbours_(neighbours), threads_(threads) {}

  void run(double near_z) {
    near_z_ = near_z;
    if (!choose_triangles() || !choose_tiles()) return;
    MeshNeighbours own;
    if (neighbours_ == nullptr) neighbours_ = &(own = find_neighbours(*grid_.mesh));
    std::vector<Row> rows(grid_.tiles_y);
    parallel_for(grid_.tiles_y, 1, threads_, [&](size_t begin, size_t end) {
      std::unique_ptr<TileScratch> scratch = take_scratch();
      for (size_t y = begin; y < end; ++y) build_row(y, *scratch, rows[y]);
      give_back(std::move(scratch));
    });
    if (is_too_much(entries_)) return grid_.tiles.clear();
    gather(rows);
  }

 private:
  struct Reference {
    uint32_t record;  // of its row
    uint16_t code;
  };
  struct Row {
    std::vector<CoverageCell> cells;
    std::vector<Reference> references;
    std::vector<CoverageTriangle> records;
  };
  struct Range {
    uint32_t lo, hi;
  };
  /// Of a triangle in the window, with margins, rounded outward.
  struct Place {
    float x_lo, x_hi, y_lo, y_hi;
  };

  std::unique_ptr<TileScratch> take_scratch() {
    const std::lock_guard lock(mutex_);
    if (unused_.empty()) return std::make_unique<TileScratch>(*neighbours_);
    std::unique_ptr<TileScratch> scratch = std::move(unused_.back());
    unused_.pop_back();
    return scratch;
  }
  void give_back(std::unique_ptr<TileScratch> scratch) {
    const std::lock_guard lock(mutex_);
    unused_.push_back(std::move(scratch));
  }

  static Place place_of(const SeenTriangle& seen) {
    const double room = 2 * seen.margin;
    return {float_below(seen.x_lo - room), float_above(seen.x_hi + room), float_below(seen.y_lo - room),
            float_above(seen.y_hi + room)};
  }

  /// False where there is nothing to see, or too much too near.
  bool choose_triangles() {
    const auto count = static_cast<uint32_t>(grid_.mesh->triangle_count());
    std::vector<uint8_t> is_seen(count);
    std::vector<Place> places(count);
    parallel_for(count, 4096, threads_, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        SeenTriangle seen;
        const Seen found = look_at(grid_, near_z_, static_cast<uint32_t>(i), seen);
        is_seen[i] = static_cast<uint8_t>(found);
        if (found == Seen::kSeen) places[i] = place_of(seen);
      }
    });
    for (uint32_t i = 0; i < count; ++i) {
      if (is_seen[i] == static_cast<uint8_t>(Seen::kSeen)) ids_.push_back(i), places_.push_back(places[i]);
      if (is_seen[i] == static_cast<uint8_t>(Seen::kNear)) grid_.near_triangles.push_back(i);
    }
    return !ids_.empty() && grid_.near_triangles.size() <= kMostNearTriangles;
  }

  /// Where large triangles lie over each other in many layers, cells would list them all: such scenes stay uncovered.
  /// What is counted does not depend on threads, and neither does the verdict: work ends early only where it is
  /// exceeded.
  bool is_too_much(uint64_t entries) const { return entries > 64 * uint64_t{ids_.size()} + (uint64_t{1} << 20); }

  /// False where tiles would hold too much.
  bool choose_tiles() {
    const double width = static_cast<double>(grid_.x_hi) - grid_.x_lo,
                 height = static_cast<double>(grid_.y_hi) - grid_.y_lo;
    const double wanted = std::max(1.0, static_cast<double>(ids_.size()) / density_.triangles_per_tile);
    const double edge = std::max(std::sqrt(width * height / wanted), std::max(width, height) / kMostTilesAcross);
    grid_.tiles_per_unit = static_cast<float>(1 / edge);
    edge_ = 1 / static_cast<double>(grid_.tiles_per_unit);
    grid_.tiles_x = static_cast<uint32_t>(std::ceil(width / edge_));
    grid_.tiles_y = static_cast<uint32_t>(std::ceil(height / edge_));
    return sort_into_tiles();
  }

  static uint32_t cell_at(double position, uint32_t count) {
    return static_cast<uint32_t>(std::clamp(std::floor(position), 0.0, static_cast<double>(count - 1)));
  }
  /// Cells of this width, `count` of them from `begin` on, that hold [lo, hi].
  static Range cells_of(float lo, float hi, double begin, double width, uint32_t count) {
    return {cell_at((lo - begin) / width, count), cell_at((hi - begin) / width, count)};
  }

  template <class Visit>
  void visit_tiles(size_t number, const Visit& visit) const {
    const Place& place = places_[number];
    const Range across = cells_of(place.x_lo, place.x_hi, grid_.x_lo, edge_, grid_.tiles_x);
    const Range down = cells_of(place.y_lo, place.y_hi, grid_.y_lo, edge_, grid_.tiles_y);
    if (across.lo == across.hi && down.lo == down.hi) return visit(down.lo * grid_.tiles_x + across.lo);
    SeenTriangle seen;
    look_at(grid_, near_z_, ids_[number], seen);
    for (uint32_t y = down.lo; y <= down.hi; ++y)
      for (uint32_t x = across.lo; x <= across.hi; ++x)
        if (seen.may_touch(grid_.x_lo + (x + 0.5) * edge_, grid_.y_lo + (y + 0.5) * edge_, edge_ / 2))
          visit(y * grid_.tiles_x + x);
  }

  bool sort_into_tiles() {
    begin_.assign(size_t{grid_.tiles_x} * grid_.tiles_y + 1, 0);
    uint64_t total = 0;
    for (size_t i = 0; i < ids_.size(); ++i) {
      visit_tiles(i, [&](uint32_t tile) { ++begin_[tile + 1], ++total; });
      if (is_too_much(total) || total > 0xffffffffu) return false;
    }
    for (size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    members_.resize(begin_.back());
    std::vector<uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (size_t i = 0; i < ids_.size(); ++i) visit_tiles(i, [&](uint32_t tile) { members_[next[tile]++] = ids_[i]; });
    grid_.tiles.resize(size_t{grid_.tiles_x} * grid_.tiles_y);
    return true;
  }

  void build_row(size_t y, TileScratch& scratch, Row& row) {
    for (uint32_t x = 0; x < grid_.tiles_x; ++x) build_tile(x, static_cast<uint32_t>(y), scratch, row);
  }

  void build_tile(uint32_t tile_x, uint32_t tile_y, TileScratch& scratch, Row& row) {
    const size_t number = size_t{tile_y} * grid_.tiles_x + tile_x;
    scratch.seen.resize(begin_[number + 1] - begin_[number]);
    for (size_t i = 0; i < scratch.seen.size(); ++i)
      look_at(grid_, near_z_, members_[begin_[number] + i], scratch.seen[i]);

    CoverageTile& tile = grid_.tiles[number];
    const double wanted = std::sqrt(density_.cells_per_triangle * static_cast<double>(scratch.seen.size()));
    tile.across = static_cast<uint32_t>(std::clamp(std::ceil(wanted), 1.0, static_cast<double>(kMostCellsAcross)));
    const double width = edge_ / tile.across;
    const double x0 = grid_.x_lo + tile_x * edge_, y0 = grid_.y_lo + tile_y * edge_;
    const auto square = [&](uint32_t x, uint32_t y) {
      return CellSquare{x0 + (x + 0.5) * width, y0 + (y + 0.5) * width, width / 2};
    };

    scratch.entries.clear();
    for (uint32_t slot = 0; slot < scratch.seen.size(); ++slot) {
      if (is_too_much(entries_)) return;
      const SeenTriangle& one = scratch.seen[slot];
      const Place place = place_of(one);
      const Range columns = cells_of(place.x_lo, place.x_hi, x0, width, tile.across);
      const Range lines = cells_of(place.y_lo, place.y_hi, y0, width, tile.across);
      const size_t before = scratch.entries.size();
      for (uint32_t y = lines.lo; y <= lines.hi; ++y)
        for (uint32_t x = columns.lo; x <= columns.hi; ++x) {
          const CellSquare cell = square(x, y);
          if (!one.may_touch(cell.x, cell.y, cell.half)) continue;
          const double highest = one.highest(cell.x, cell.y, cell.half), lowest = one.lowest(cell.x, cell.y, cell.half);
          scratch.entries.push_back(
              {y * tile.across + x, {static_cast<float>(highest), static_cast<float>(lowest), slot}});
        }
      entries_ += scratch.entries.size() - before;
    }
    const size_t cells = size_t{tile.across} * tile.across;
    scratch.sort_entries(cells);
    scratch.covers.resize(cells);
    for (size_t i = 0; i < cells; ++i)
      scratch.covers[i] =
          scratch.sheets.cover(scratch.seen, scratch.list(i),
                               square(static_cast<uint32_t>(i) % tile.across, static_cast<uint32_t>(i) / tile.across));
    set_codes(scratch, tile);
    scratch.record.assign(scratch.seen.size(), kNoTriangle);
    for (size_t i = 0; i < cells; ++i) write_cell(tile, scratch, i, row);
  }

  /// Room for the errors of depths of about this size, and of their codes.
  float slack(float s) const { return static_cast<float>(2 * grid_.errors.depth_error(s)); }

  /// Codes of the depths that matter in the tile.
  void set_codes(TileScratch& scratch, CoverageTile& tile) const {
    float lo = kInf, hi = -kInf;
    for (size_t i = 0; i < scratch.covers.size(); ++i)
      for (const InCell& one : scratch.list(i)) {
        const float cover = scratch.covers[i];
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
  static float code(const CoverageTile& tile, float s) { return (s - tile.lowest) * tile.per_depth + kFirstCode; }
  uint16_t code_above(const CoverageTile& tile, float s) const {
    return static_cast<uint16_t>(std::clamp(std::ceil(code(tile, s + slack(s))) + 2, 1.0f, 65535.0f));
  }
  uint16_t code_below(const CoverageTile& tile, float s) const {
    return static_cast<uint16_t>(std::clamp(std::floor(code(tile, s - slack(s))) - 2, 0.0f, 65535.0f));
  }

  void write_cell(const CoverageTile& tile, TileScratch& scratch, size_t number, Row& row) const {
    const float cover = scratch.covers[number];
    std::span<InCell> list = scratch.list(number);
    CoverageCell cell;
    cell.first = static_cast<uint32_t>(row.references.size());
    if (cover > -kInf) cell.cover = code_below(tile, cover);
    // What lies wholly behind the cover, with room for ties, is nobody's first hit.
    if (cover > -kInf) {
      const float behind = cover - 4 * slack(cover) - static_cast<float>(grid_.errors.depth * 8);
      const auto end =
          std::remove_if(list.begin(), list.end(), [&](const InCell& one) { return one.highest < behind; });
      list = list.first(static_cast<size_t>(end - list.begin()));
    }
    const std::vector<SeenTriangle>& seen = scratch.seen;
    std::sort(list.begin(), list.end(), [&](const InCell& a, const InCell& b) {
      return a.highest != b.highest ? a.highest > b.highest : seen[a.slot].record.id < seen[b.slot].record.id;
    });
    if (!list.empty()) cell.far = code_above(tile, list.front().highest);
    for (const InCell& one : list) {
      uint32_t& record = scratch.record[one.slot];
      if (record == kNoTriangle) {
        record = static_cast<uint32_t>(row.records.size());
        row.records.push_back(seen[one.slot].record);
      }
      row.references.push_back({record, code_above(tile, one.highest)});
    }
    row.cells.push_back(cell);
  }

  /// Puts rows together, and numbers the triangles that cells refer to in the order of their first mention.
  void gather(std::vector<Row>& rows) {
    std::vector<uint32_t> number(grid_.mesh->triangle_count(), kNoTriangle);
    size_t cells = 0, references = 0, triangles = 0;
    for (const Row& row : rows) {
      cells += row.cells.size(), references += row.references.size();
      for (const CoverageTriangle& record : row.records) triangles += std::exchange(number[record.id], 0) != 0;
    }
    if (references > 0xffffffffu || cells > 0xffffffffu)
      throw Error(ErrorCode::kLimit, "coverage", "more than 2^32 cells or references");
    std::fill(number.begin(), number.end(), kNoTriangle);
    grid_.allocate(triangles, cells + 1, references);
    uint32_t tile = 0, cell_number = 0, reference_number = 0, known_number = 0;
    for (Row& row : rows) {
      uint32_t first_cell = cell_number;
      for (uint32_t x = 0; x < grid_.tiles_x; ++x, ++tile) {
        grid_.tiles[tile].first_cell = first_cell;
        first_cell += grid_.tiles[tile].across * grid_.tiles[tile].across;
      }
      const uint32_t first = reference_number;
      for (const Reference& reference : row.references) {
        const CoverageTriangle& record = row.records[reference.record];
        uint32_t& known = number[record.id];
        if (known == kNoTriangle) grid_.triangles[known = known_number++] = record;
        grid_.references[reference_number++] = {static_cast<uint16_t>(known), static_cast<uint16_t>(known >> 16),
                                                reference.code};
      }
      for (CoverageCell cell : row.cells) {
        cell.first += first;
        if (cell.first < reference_number) cell.top = grid_.references[cell.first].triangle();
        grid_.cells[cell_number++] = cell;
      }
      row = {};
    }
    grid_.cells[cell_number] = {0, 0, reference_number};
  }

  CoverageGrid& grid_;
  const CoverageDensity& density_;
  const MeshNeighbours* neighbours_;
  const unsigned threads_;
  double near_z_ = 0, edge_ = 1;
  std::atomic<uint64_t> entries_ = 0;  // of all cells so far
  std::vector<uint32_t> ids_, begin_, members_;
  std::vector<Place> places_;  // parallel to ids_
  std::mutex mutex_;
  std::vector<std::unique_ptr<TileScratch>> unused_;
};

}  // namespace

CoverageGrid build_coverage(std::shared_ptr<const TriangleMesh> mesh, const AreaGeometry& area,
                            const CoverageDensity& density, const MeshNeighbours* neighbours, unsigned threads) {
  CoverageGrid grid;
  grid.mesh = std::move(mesh);
  if (const auto near_z = set_window(grid, area)) Builder(grid, density, neighbours, threads).run(*near_z);
  return grid;
}

}  // namespace raygrain
