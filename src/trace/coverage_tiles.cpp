#include "trace/coverage_tiles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "geometry/rounding.h"

namespace raygrain {
namespace {

constexpr uint32_t kMostTilesAcross = 2048;
constexpr size_t kMostNearTriangles = 16;

uint32_t cell_at(double position, uint32_t count) {
  return static_cast<uint32_t>(std::clamp(std::floor(position), 0.0, static_cast<double>(count - 1)));
}

class TileFinder {
 public:
  TileFinder(CoverageGrid& grid, double near_z, const CoverageDensity& density, unsigned threads)
      : grid_(grid), density_(density), threads_(threads) {
    members_.near_z = near_z;
  }

  std::optional<TileMembers> find() {
    if (!choose_triangles() || !choose_tiles()) return std::nullopt;
    return std::move(members_);
  }

 private:
  /// False where there is nothing to see, or too much too near.
  bool choose_triangles() {
    const auto count = static_cast<uint32_t>(grid_.mesh->triangle_count());
    std::vector<uint8_t> is_seen(count);
    std::vector<WindowPlace> places(count);
    parallel_for(count, 4096, threads_, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        SeenTriangle seen;
        const Seen found = look_at(grid_, members_.near_z, static_cast<uint32_t>(i), seen);
        is_seen[i] = static_cast<uint8_t>(found);
        if (found == Seen::kSeen) places[i] = place_of(seen);
      }
    });
    for (uint32_t i = 0; i < count; ++i) {
      if (is_seen[i] == static_cast<uint8_t>(Seen::kSeen)) seen_.push_back(i), places_.push_back(places[i]);
      if (is_seen[i] == static_cast<uint8_t>(Seen::kNear)) grid_.near_triangles.push_back(i);
    }
    members_.seen = seen_.size();
    return !seen_.empty() && grid_.near_triangles.size() <= kMostNearTriangles;
  }

  /// False where tiles would hold too much.
  bool choose_tiles() {
    const double width = static_cast<double>(grid_.x_hi) - grid_.x_lo,
                 height = static_cast<double>(grid_.y_hi) - grid_.y_lo;
    const double wanted = std::max(1.0, static_cast<double>(seen_.size()) / density_.triangles_per_tile);
    const double edge = std::max(std::sqrt(width * height / wanted), std::max(width, height) / kMostTilesAcross);
    grid_.tiles_per_unit = static_cast<float>(1 / edge);
    members_.edge = 1 / static_cast<double>(grid_.tiles_per_unit);
    grid_.tiles_x = static_cast<uint32_t>(std::ceil(width / members_.edge));
    grid_.tiles_y = static_cast<uint32_t>(std::ceil(height / members_.edge));
    return sort_into_tiles();
  }

  template <class Visit>
  void visit_tiles(size_t number, const Visit& visit) const {
    const WindowPlace& place = places_[number];
    const CellRange across = cells_of(place.x_lo, place.x_hi, grid_.x_lo, members_.edge, grid_.tiles_x);
    const CellRange down = cells_of(place.y_lo, place.y_hi, grid_.y_lo, members_.edge, grid_.tiles_y);
    if (across.lo == across.hi && down.lo == down.hi) return visit(down.lo * grid_.tiles_x + across.lo);
    SeenTriangle seen;
    look_at(grid_, members_.near_z, seen_[number], seen);
    for (uint32_t y = down.lo; y <= down.hi; ++y)
      for (uint32_t x = across.lo; x <= across.hi; ++x)
        if (seen.may_touch(grid_.x_lo + (x + 0.5) * members_.edge, grid_.y_lo + (y + 0.5) * members_.edge,
                           members_.edge / 2))
          visit(y * grid_.tiles_x + x);
  }

  bool sort_into_tiles() {
    members_.begin.assign(size_t{grid_.tiles_x} * grid_.tiles_y + 1, 0);
    uint64_t total = 0;
    for (size_t i = 0; i < seen_.size(); ++i) {
      visit_tiles(i, [&](uint32_t tile) { ++members_.begin[tile + 1], ++total; });
      if (members_.is_too_much(total) || total > 0xffffffffu) return false;
    }
    for (size_t i = 1; i < members_.begin.size(); ++i) members_.begin[i] += members_.begin[i - 1];
    members_.ids.resize(members_.begin.back());
    std::vector<uint32_t> next(members_.begin.begin(), members_.begin.end() - 1);
    for (size_t i = 0; i < seen_.size(); ++i)
      visit_tiles(i, [&](uint32_t tile) { members_.ids[next[tile]++] = seen_[i]; });
    grid_.tiles.resize(size_t{grid_.tiles_x} * grid_.tiles_y);
    return true;
  }

  CoverageGrid& grid_;
  const CoverageDensity& density_;
  const unsigned threads_;
  TileMembers members_;
  std::vector<uint32_t> seen_;
  std::vector<WindowPlace> places_;  // parallel to seen_
};

}  // namespace

WindowPlace place_of(const SeenTriangle& seen) {
  const double room = 2 * seen.margin;
  return {float_below(seen.x_lo - room), float_above(seen.x_hi + room), float_below(seen.y_lo - room),
          float_above(seen.y_hi + room)};
}

CellRange cells_of(float lo, float hi, double begin, double width, uint32_t count) {
  return {cell_at((lo - begin) / width, count), cell_at((hi - begin) / width, count)};
}

std::optional<TileMembers> find_tile_members(CoverageGrid& grid, double near_z, const CoverageDensity& density,
                                             unsigned threads) {
  return TileFinder(grid, near_z, density, threads).find();
}

}  // namespace raygrain
