// From a mesh and an area to the grid: tiles of about equal numbers of triangles' places, each cut into as many cells
// as it has use for.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "raygrain/error.h"
#include "raygrain/ray_frame.h"

#include "base/parallel.h"
#include "trace/coverage_grid.h"
#include "trace/coverage_sheets.h"
#include "trace/coverage_triangle.h"

namespace raygrain {
namespace {

constexpr double kRoundoff = 0x1p-24;
constexpr uint32_t kMostLevels = 7;
constexpr uint32_t kMostTilesAcross = 2048;
constexpr size_t kMostNearTriangles = 16;

struct Rectangle {
  double x_lo, x_hi, y_lo, y_hi;
};

double largest(Vec3 a) {
  return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
}

/// Sheared onto the coordinate plane that faces the light most: edges along its two axes stay along the cells.
void set_parallel_map(CoverageGrid& grid, Vec3 direction, const Bounds& box) {
  const double d[3] = {std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)};
  const size_t axis = d[0] > d[1] ? (d[0] > d[2] ? 0 : 2) : (d[1] > d[2] ? 1 : 2);
  const FrameKind kinds[3] = {FrameKind::kShearX, FrameKind::kShearY, FrameKind::kShearZ};
  grid.map.center = center(box);
  const RayFrame frame = *parallel_frame(kinds[axis], direction, grid.map.center);
  grid.map.rows = {frame.rows[0], frame.rows[1], -frame.rows[2]};
}

Rectangle rectangle_of(const CoverageGrid& grid, std::span<const Vec3> points) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Rectangle r{kInfinity, -kInfinity, kInfinity, -kInfinity};
  for (const Vec3 p : points) {
    const Vec3d q = grid.map.turned(p);
    r = {std::min(r.x_lo, q.x), std::max(r.x_hi, q.x), std::min(r.y_lo, q.y), std::max(r.y_hi, q.y)};
  }
  return r;
}

double row_length(Vec3d row) {
  return std::abs(row.x) + std::abs(row.y) + std::abs(row.z);
}

/// The window of parallel rays and the errors inside it.
bool set_parallel_window(CoverageGrid& grid, const AreaGeometry& area, const Bounds& box) {
  std::vector<Vec3> corners;
  for (const Vec3d corner : area.region().outer_corners) corners.push_back(to_float(corner));
  const Rectangle window = rectangle_of(grid, corners);
  const Rectangle scene = rectangle_of(grid, grid.mesh->vertices);
  const double reach = std::max<double>(largest(extent(box)), 0x1p-100) / 2;
  const double rows =
      std::max({row_length(grid.map.rows[0]), row_length(grid.map.rows[1]), row_length(grid.map.rows[2])});
  ColumnErrors& e = grid.errors;
  e.greatest_s = 2 * reach;
  for (const Vec3 corner : corners) e.greatest_s = std::max(e.greatest_s, std::abs(grid.map.turned(corner).z) * 1.01);
  e.greatest_s = std::min(e.greatest_s, 16 * reach);
  e.greatest_xy = 2 * rows * reach;
  const double farthest = e.greatest_xy + e.greatest_s * rows;  // from the center, of queries
  e.place = 8 * kRoundoff * rows * farthest + 16 * kRoundoff * e.greatest_xy;
  e.drift = kMostSlope * (e.greatest_s + reach * rows);
  e.evaluation = 32 * kRoundoff * e.greatest_xy;
  e.depth = 8 * kRoundoff * rows * farthest;
  const double room = 4 * (e.place + e.drift + e.evaluation);
  grid.x_lo = static_cast<float>(std::max(window.x_lo, scene.x_lo) - room);
  grid.x_hi = static_cast<float>(std::min(window.x_hi, scene.x_hi) + room);
  grid.y_lo = static_cast<float>(std::max(window.y_lo, scene.y_lo) - room);
  grid.y_hi = static_cast<float>(std::min(window.y_hi, scene.y_hi) + room);
  grid.is_free_beside =
      window.x_lo <= scene.x_lo && window.x_hi >= scene.x_hi && window.y_lo <= scene.y_lo && window.y_hi >= scene.y_hi;
  grid.s_lo = static_cast<float>(-e.greatest_s), grid.s_hi = static_cast<float>(e.greatest_s);
  return grid.x_lo < grid.x_hi && grid.y_lo < grid.y_hi;
}

/// The window of an eye and the errors inside it. Returns the depth below which columns mean nothing.
double set_eye_window(CoverageGrid& grid, const AreaGeometry& area) {
  const auto& shape = std::get<PointArea>(area.area().shape);
  grid.map.is_eye = true;
  grid.map.center = shape.eye;
  grid.map.rows = {area.frame().right, area.frame().up, area.frame().forward};
  double farthest = shape.far_z;
  for (const Vec3 p : grid.mesh->vertices) farthest = std::max(farthest, grid.map.turned(p).z);
  farthest *= 1.01;
  const Vec2d half = area.window_half();
  ColumnErrors& e = grid.errors;
  const double size = std::max(half.x, half.y), slant = std::sqrt(1 + 2 * size * size);
  e.greatest_xy = size;
  e.place = (16 * slant * (1 + size) + 16 * size) * kRoundoff;
  e.drift = 1.25 * kMostOffset * slant * (1 + size) * farthest;
  e.end = 4 * kMostOffset * slant * farthest;
  e.evaluation = 16 * (1 + size) * kRoundoff;
  e.relative_depth = 32 * slant * kRoundoff;
  grid.x_lo = static_cast<float>(-half.x), grid.x_hi = static_cast<float>(half.x);
  grid.y_lo = static_cast<float>(-half.y), grid.y_hi = static_cast<float>(half.y);
  const double near_z = std::max<double>(shape.near_z, 0x1p10 * e.drift / size);
  e.greatest_s = 1 / near_z;
  grid.s_lo = static_cast<float>(1 / farthest), grid.s_hi = static_cast<float>(1 / near_z);
  return near_z;
}

/// The triangles that the light may see, and for each tile which of them.
struct Tiled {
  std::vector<uint32_t> triangles;  // ids
  std::vector<uint32_t> begin, members;
};

class Builder {
 public:
  Builder(CoverageGrid& grid, const CoverageDensity& density, unsigned threads)
      : grid_(grid), density_(density), threads_(threads) {}

  void run(double near_z) {
    near_z_ = near_z;
    if (!choose_triangles() || !choose_tiles()) return;
    neighbours_ = find_neighbours(*grid_.mesh);
    std::vector<Row> rows(grid_.tiles_y);
    parallel_for(grid_.tiles_y, 1, threads_, [&](size_t begin, size_t end) {
      SheetFinder sheets(neighbours_, grid_.mesh->triangle_count());
      for (size_t y = begin; y < end; ++y) build_row(y, sheets, rows[y]);
    });
    if (is_too_much(entries_)) return grid_.tiles.clear();
    gather(rows);
  }

 private:
  struct Row {
    std::vector<CoverageCell> cells;
    std::vector<std::pair<uint32_t, uint16_t>> references;  // id and code
  };
  struct Range {
    uint32_t lo, hi;
  };

  /// False where there is nothing to see, or too much too near.
  bool choose_triangles() {
    const auto count = static_cast<uint32_t>(grid_.mesh->triangle_count());
    std::vector<uint8_t> is_seen(count);
    parallel_for(count, 4096, threads_, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        SeenTriangle seen;
        is_seen[i] = static_cast<uint8_t>(look_at(grid_, near_z_, static_cast<uint32_t>(i), seen));
      }
    });
    for (uint32_t i = 0; i < count; ++i) {
      if (is_seen[i] == static_cast<uint8_t>(Seen::kSeen)) ids_.push_back(i);
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
  Range columns(const SeenTriangle& seen) const {
    const double room = 2 * seen.margin;
    return {cell_at((seen.x_lo - room - grid_.x_lo) / edge_, grid_.tiles_x),
            cell_at((seen.x_hi + room - grid_.x_lo) / edge_, grid_.tiles_x)};
  }
  Range rows(const SeenTriangle& seen) const {
    const double room = 2 * seen.margin;
    return {cell_at((seen.y_lo - room - grid_.y_lo) / edge_, grid_.tiles_y),
            cell_at((seen.y_hi + room - grid_.y_lo) / edge_, grid_.tiles_y)};
  }

  template <class Visit>
  void visit_tiles(uint32_t id, const Visit& visit) const {
    SeenTriangle seen;
    look_at(grid_, near_z_, id, seen);
    const Range across = columns(seen), down = rows(seen);
    const bool is_alone = across.lo == across.hi && down.lo == down.hi;
    for (uint32_t y = down.lo; y <= down.hi; ++y)
      for (uint32_t x = across.lo; x <= across.hi; ++x)
        if (is_alone || seen.may_touch(grid_.x_lo + (x + 0.5) * edge_, grid_.y_lo + (y + 0.5) * edge_, edge_ / 2))
          visit(y * grid_.tiles_x + x);
  }

  bool sort_into_tiles() {
    begin_.assign(size_t{grid_.tiles_x} * grid_.tiles_y + 1, 0);
    uint64_t total = 0;
    for (const uint32_t id : ids_) {
      visit_tiles(id, [&](uint32_t tile) { ++begin_[tile + 1], ++total; });
      if (is_too_much(total) || total > 0xffffffffu) return false;
    }
    for (size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    members_.resize(begin_.back());
    std::vector<uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (const uint32_t id : ids_) visit_tiles(id, [&](uint32_t tile) { members_[next[tile]++] = id; });
    grid_.tiles.resize(size_t{grid_.tiles_x} * grid_.tiles_y);
    return true;
  }

  void build_row(size_t y, SheetFinder& sheets, Row& row) {
    for (uint32_t x = 0; x < grid_.tiles_x; ++x) build_tile(x, static_cast<uint32_t>(y), sheets, row);
  }

  void build_tile(uint32_t tile_x, uint32_t tile_y, SheetFinder& sheets, Row& row) {
    const size_t number = size_t{tile_y} * grid_.tiles_x + tile_x;
    std::vector<SeenTriangle> seen(begin_[number + 1] - begin_[number]);
    for (size_t i = 0; i < seen.size(); ++i) look_at(grid_, near_z_, members_[begin_[number] + i], seen[i]);

    CoverageTile& tile = grid_.tiles[number];
    while (tile.levels < kMostLevels && static_cast<double>(1u << (2 * tile.levels)) <
                                            density_.cells_per_triangle * static_cast<double>(seen.size()))
      ++tile.levels;
    const uint32_t across = 1u << tile.levels;
    const double width = edge_ / across;
    const double x0 = grid_.x_lo + tile_x * edge_, y0 = grid_.y_lo + tile_y * edge_;
    const auto square = [&](uint32_t x, uint32_t y) {
      return CellSquare{x0 + (x + 0.5) * width, y0 + (y + 0.5) * width, width / 2};
    };

    std::vector<std::vector<InCell>> lists(size_t{across} * across);
    for (uint32_t slot = 0; slot < seen.size(); ++slot) {
      if (is_too_much(entries_)) return;
      const SeenTriangle& one = seen[slot];
      const double room = 2 * one.margin;
      const Range columns{cell_at((one.x_lo - room - x0) / width, across),
                          cell_at((one.x_hi + room - x0) / width, across)};
      const Range lines{cell_at((one.y_lo - room - y0) / width, across),
                        cell_at((one.y_hi + room - y0) / width, across)};
      uint64_t entries = 0;
      for (uint32_t y = lines.lo; y <= lines.hi; ++y)
        for (uint32_t x = columns.lo; x <= columns.hi; ++x) {
          const CellSquare cell = square(x, y);
          if (!one.may_touch(cell.x, cell.y, cell.half)) continue;
          const double highest = one.highest(cell.x, cell.y, cell.half), lowest = one.lowest(cell.x, cell.y, cell.half);
          lists[size_t{y} * across + x].push_back({static_cast<float>(highest), static_cast<float>(lowest), slot});
          ++entries;
        }
      entries_ += entries;
    }

    std::vector<float> covers(lists.size());
    for (size_t i = 0; i < lists.size(); ++i)
      covers[i] =
          sheets.cover(seen, lists[i], square(static_cast<uint32_t>(i) % across, static_cast<uint32_t>(i) / across));
    set_codes(lists, covers, tile);
    for (size_t i = 0; i < lists.size(); ++i) write_cell(tile, seen, covers[i], lists[i], row);
  }

  /// Room for the errors of depths of about this size, and of their codes.
  float slack(float s) const { return static_cast<float>(2 * grid_.errors.depth_error(s)); }

  /// Codes of the depths that matter in the tile.
  void set_codes(std::span<const std::vector<InCell>> lists, std::span<const float> covers, CoverageTile& tile) const {
    float lo = kInf, hi = -kInf;
    for (size_t i = 0; i < lists.size(); ++i)
      for (const InCell& one : lists[i]) {
        if (one.highest < covers[i]) continue;
        hi = std::max(hi, one.highest);
        lo = std::min(lo, covers[i] > -kInf ? covers[i] : one.highest);
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

  void write_cell(const CoverageTile& tile, std::span<const SeenTriangle> seen, float cover, std::vector<InCell>& list,
                  Row& row) const {
    CoverageCell cell;
    cell.first = static_cast<uint32_t>(row.references.size());
    if (cover > -kInf) cell.cover = code_below(tile, cover);
    // What lies wholly behind the cover, with room for ties, is nobody's first hit.
    if (cover > -kInf) {
      const float behind = cover - 4 * slack(cover) - static_cast<float>(grid_.errors.depth * 8);
      std::erase_if(list, [&](const InCell& one) { return one.highest < behind; });
    }
    std::sort(list.begin(), list.end(), [&](const InCell& a, const InCell& b) {
      return a.highest != b.highest ? a.highest > b.highest : seen[a.slot].record.id < seen[b.slot].record.id;
    });
    if (!list.empty()) cell.far = code_above(tile, list.front().highest);
    for (const InCell& one : list) row.references.emplace_back(seen[one.slot].record.id, code_above(tile, one.highest));
    row.cells.push_back(cell);
  }

  /// Puts rows together, and numbers the triangles that cells refer to in the order of their first mention.
  void gather(std::vector<Row>& rows) {
    std::vector<uint32_t> number(grid_.mesh->triangle_count(), kNoTriangle);
    size_t cells = 0, references = 0;
    for (const Row& row : rows) cells += row.cells.size(), references += row.references.size();
    if (references > 0xffffffffu || cells > 0xffffffffu)
      throw Error(ErrorCode::kLimit, "coverage", "more than 2^32 cells or references");
    grid_.cells.reserve(cells + 1);
    grid_.references.reserve(references);
    std::vector<uint32_t> used;
    uint32_t tile = 0;
    for (Row& row : rows) {
      const auto first = static_cast<uint32_t>(grid_.references.size());
      auto cell_number = static_cast<uint32_t>(grid_.cells.size());
      for (uint32_t x = 0; x < grid_.tiles_x; ++x, ++tile) {
        grid_.tiles[tile].first_cell = cell_number;
        cell_number += 1u << (2 * grid_.tiles[tile].levels);
      }
      for (CoverageCell cell : row.cells) {
        cell.first += first;
        grid_.cells.push_back(cell);
      }
      for (const auto& [id, top] : row.references) {
        if (number[id] == kNoTriangle) {
          number[id] = static_cast<uint32_t>(used.size());
          used.push_back(id);
        }
        grid_.references.push_back({static_cast<uint16_t>(number[id]), static_cast<uint16_t>(number[id] >> 16), top});
      }
      row = {};
    }
    grid_.cells.push_back({0, 0, static_cast<uint32_t>(grid_.references.size())});
    grid_.triangles.resize(used.size());
    parallel_for(used.size(), 4096, threads_, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        SeenTriangle seen;
        look_at(grid_, near_z_, used[i], seen);
        grid_.triangles[i] = seen.record;
      }
    });
  }

  CoverageGrid& grid_;
  const CoverageDensity& density_;
  const unsigned threads_;
  double near_z_ = 0, edge_ = 1;
  std::atomic<uint64_t> entries_ = 0;  // of all cells so far
  std::vector<uint32_t> ids_, begin_, members_;
  std::vector<std::array<uint32_t, 3>> neighbours_;
};

/// Products of coordinates must neither overflow nor vanish.
bool fits_floats(const Bounds& box) {
  const Vec3 lo = box.lo, hi = box.hi, size = extent(box);
  const float farthest =
      std::max({std::abs(lo.x), std::abs(lo.y), std::abs(lo.z), std::abs(hi.x), std::abs(hi.y), std::abs(hi.z)});
  return farthest <= 0x1p30f && std::max({size.x, size.y, size.z}) >= 0x1p-30f;
}

}  // namespace

CoverageGrid build_coverage(std::shared_ptr<const TriangleMesh> mesh, const AreaGeometry& area,
                            const CoverageDensity& density, unsigned threads) {
  CoverageGrid grid;
  grid.mesh = std::move(mesh);
  const Bounds box = mesh_bounds(*grid.mesh);
  if (is_empty(box) || !fits_floats(box)) return grid;
  double near_z = 0;
  if (area.is_plane()) {
    set_parallel_map(grid, std::get<PlaneArea>(area.area().shape).direction, box);
    if (!set_parallel_window(grid, area, box)) return grid;
  } else {
    near_z = set_eye_window(grid, area);
  }
  for (size_t i = 0; i < 3; ++i) grid.map.float_rows[i] = to_float(grid.map.rows[i]);
  Builder(grid, density, threads).run(near_z);
  return grid;
}

}  // namespace raygrain
