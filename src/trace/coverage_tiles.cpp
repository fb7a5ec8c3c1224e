#include "trace/coverage_tiles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"

namespace raygrain {
namespace {

constexpr uint32_t kMostTilesAcross = 2048;
constexpr size_t kMostNearTriangles = 16;

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
    places_.resize(count);
    parallel_for(count, 4096, threads_, [&](size_t begin, size_t end) {
      SeenTriangle seen;
      for (size_t i = begin; i < end; ++i) {
        const Seen found = place_in_window(grid_, members_.near_z, static_cast<uint32_t>(i), seen);
        is_seen[i] = static_cast<uint8_t>(found);
        if (found == Seen::kSeen) places_[i] = place_of(seen);
      }
    });
    seen_.reserve(count);
    for (uint32_t i = 0; i < count; ++i) {
      if (is_seen[i] == static_cast<uint8_t>(Seen::kSeen)) {
        places_[seen_.size()] = places_[i];
        seen_.push_back(i);
      }
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

  /// Appends the tiles of a triangle.
  void list_tiles(size_t number, std::vector<uint32_t>& tiles) const {
    const WindowPlace& place = places_[number];
    const CellRange across = cells_of(place.x_lo, place.x_hi, grid_.x_lo, members_.edge, grid_.tiles_x);
    const CellRange down = cells_of(place.y_lo, place.y_hi, grid_.y_lo, members_.edge, grid_.tiles_y);
    if (across.lo == across.hi && down.lo == down.hi) return tiles.push_back(down.lo * grid_.tiles_x + across.lo);
    SeenTriangle seen;
    look_at(grid_, members_.near_z, seen_[number], seen);
    for (uint32_t y = down.lo; y <= down.hi; ++y)
      for (uint32_t x = across.lo; x <= across.hi; ++x)
        if (seen.may_touch(grid_.x_lo + (x + 0.5) * members_.edge, grid_.y_lo + (y + 0.5) * members_.edge,
                           members_.edge / 2))
          tiles.push_back(y * grid_.tiles_x + x);
  }

  bool sort_into_tiles() {
    members_.begin.assign(size_t{grid_.tiles_x} * grid_.tiles_y + 1, 0);
    std::vector<uint32_t> tiles, ends(seen_.size());  // of all triangles; where those of each end
    tiles.reserve(seen_.size() + seen_.size() / 2);
    for (size_t i = 0; i < seen_.size(); ++i) {
      list_tiles(i, tiles);
      if (members_.is_too_much(tiles.size()) || tiles.size() > 0xffffffffu) return false;
      ends[i] = static_cast<uint32_t>(tiles.size());
    }
    for (const uint32_t tile : tiles) ++members_.begin[tile + 1];
    for (size_t i = 1; i < members_.begin.size(); ++i) members_.begin[i] += members_.begin[i - 1];
    members_.ids.resize(members_.begin.back());
    std::vector<uint32_t> next(members_.begin.begin(), members_.begin.end() - 1);
    for (size_t i = 0, at = 0; i < seen_.size(); ++i)
      for (; at < ends[i]; ++at) members_.ids[next[tiles[at]]++] = seen_[i];
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

std::optional<TileMembers> find_tile_members(CoverageGrid& grid, double near_z, const CoverageDensity& density,
                                             unsigned threads) {
  return TileFinder(grid, near_z, density, threads).find();
}

}  // namespace raygrain
