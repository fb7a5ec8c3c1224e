// What a Coverage holds. The map and its error bounds are proven in docs/theory-coverage.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include "raygrain/area.h"
#include "raygrain/mesh.h"

#include "trace/wide_tree.h"

namespace raygrain {

/// The world as the light sees it: a column (x, y) for each of its rays, and a depth s that grows towards the light.
/// With q = rows . (p - center): (q.x, q.y, q.z) for parallel rays, (q.x / q.z, q.y / q.z, 1 / q.z) for an eye.
struct ColumnMap {
  bool is_eye = false;
  std::array<Vec3d, 3> rows;
  Vec3 center;
  Vec3 float_rows[3];  // rounded

  Vec3d turned(Vec3 p) const {
    const Vec3d v = to_double(p) - to_double(center);
    return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
  }
};

/// Parallel rays are columns as far as their direction leaves the light's by at most this slope (in the map).
inline constexpr double kMostSlope = 0x1p-22;

/// Rays to and from an eye are columns as far as their line passes it within this part of their length.
inline constexpr double kMostOffset = 0x1p-22;

/// Bounds of errors in the map's units: of a query's place, and how far a ray may leave its column.
struct ColumnErrors {
  double place = 0;       // of x and y
  double drift = 0;       // parallel rays: everywhere; of an eye: at depth s, drift * s
  double evaluation = 0;  // of an edge's float arithmetic
  double depth = 0;       // of s: depth + relative_depth * s
  double relative_depth = 0;
  double end = 0;                          // of the end of a ray that ends at an eye
  double greatest_xy = 0, greatest_s = 0;  // of queries and of what they meet

  double depth_error(double s) const { return depth + relative_depth * (s < 0 ? -s : s); }
};

/// A triangle as a column meets it: lanes 0-2 are signed distances to its edges (inside is positive), lane 3 tells how
/// far the triangle is ahead of a query. Each lane is a . x + b . y + c, plus `ahead` * s in lane 3, and wrong by less
/// than `margin`.
struct alignas(64) CoverageTriangle {
  float a[4], b[4], c[4];
  float margin;
  uint32_t id;
  float per_ahead;  // -1 / ahead; 0 where the depth is not well known
  float ahead;      // <= 0
};
static_assert(sizeof(CoverageTriangle) == 64);

/// Depths in cells are codes of their tile: (s - lowest) / step + kFirstCode, rounded to the safe side.
inline constexpr float kFirstCode = 100;
inline constexpr float kLastCode = 65400;

struct CoverageCell {
  uint16_t cover = 0;  // a query with a lower code is hidden; 0: none is
  uint16_t far = 0;    // a query with a higher code is free
  uint32_t first = 0;  // of its references; they end where those of the next cell begin
  uint32_t top = 0;    // the triangle of the first one, to be fetched before the reference is there
};

struct CoverageTile {
  uint32_t first_cell = 0;
  uint32_t across = 1;              // across x across cells
  float lowest = 0, per_depth = 1;  // codes per unit of depth
};

/// A triangle in a cell, nearest to the light first. Six bytes.
struct CoverageReference {
  uint16_t low = 0, high = 0;  // of the triangle's number
  uint16_t top = 0;            // no query with a higher code can be hidden by it

  uint32_t triangle() const { return low | static_cast<uint32_t>(high) << 16; }
};
static_assert(sizeof(CoverageReference) == 6);

struct CoverageGrid {
  std::shared_ptr<const TriangleMesh> mesh;
  ColumnMap map;
  ColumnErrors errors;
  float x_lo = 0, y_lo = 0, x_hi = 0, y_hi = 0;  // queries inside are answered
  float s_lo = 0, s_hi = 0;
  bool is_free_beside = false;  // no triangle is in columns that leave the window sideways
  float tiles_per_unit = 1;
  uint32_t tiles_x = 0, tiles_y = 0;
  std::vector<CoverageTile> tiles;
  LineMemory memory;  // of the following: together, so that large pages serve them
  std::span<CoverageTriangle> triangles;
  std::span<CoverageCell> cells;  // and one more
  std::span<CoverageReference> references;
  std::vector<uint32_t> near_triangles;  // ids of those that all rays of an eye must ask

  bool is_useful() const { return !cells.empty(); }

  void allocate(size_t triangle_count, size_t cell_count, size_t reference_count) {
    const size_t cells_at = triangle_count * sizeof(CoverageTriangle);
    const size_t references_at = cells_at + cell_count * sizeof(CoverageCell);
    memory = LineMemory(references_at + reference_count * sizeof(CoverageReference));
    triangles = {new (memory.data()) CoverageTriangle[triangle_count], triangle_count};
    cells = {new (memory.data() + cells_at) CoverageCell[cell_count], cell_count};
    references = {new (memory.data() + references_at) CoverageReference[reference_count], reference_count};
  }
};

struct CoverageDensity {
  double cells_per_triangle, triangles_per_tile;
};

/// Per triangle and edge (from corner i to corner i + 1): the one other triangle with the same two points at its ends,
/// or kNoNeighbour where there is none or more than one.
using MeshNeighbours = std::vector<std::array<uint32_t, 3>>;
inline constexpr uint32_t kNoNeighbour = 0xffffffffu;
MeshNeighbours find_neighbours(const TriangleMesh& mesh);

/// Useless (without cells) where nothing can be seen or too much is too near to an eye. Deterministic. `neighbours` of
/// the mesh where they are known, or null.
CoverageGrid build_coverage(std::shared_ptr<const TriangleMesh> mesh, const AreaGeometry& area,
                            const CoverageDensity& density, const MeshNeighbours* neighbours, unsigned threads);

}  // namespace raygrain
