// The two questions to a coverage grid. Cells decide what they can; the others wait, are sorted by tile where there are
// many, and meet their triangles, a few of them in flight at a time. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_COVERAGE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_COVERAGE_INL_H
#undef RAYGRAIN_TRACE_KERNELS_COVERAGE_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_COVERAGE_INL_H
#endif

#include <array>
#include <cmath>

#include <hwy/cache_control.h>

#include "raygrain/triangle.h"

#include "trace/kernels/columns-inl.h"
#include "trace/kernels/pairs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

/// A ray whose cell alone does not tell.
struct Waiting {
  float x, y, s;
  uint32_t first, count;  // of its cell's references
  uint32_t number;        // of the ray
  uint32_t tile;
  uint16_t code, spare;
};
static_assert(sizeof(Waiting) == 32);

HWY_INLINE bool confirm(const CoverageGrid& grid, uint32_t id, const Ray& ray, Hit& hit) {
  const TriangleMesh& mesh = *grid.mesh;
  if (!intersect_triangle(ray, mesh.vertex(id, 0), mesh.vertex(id, 1), mesh.vertex(id, 2), hit)) return false;
  hit.triangle = id;
  return true;
}

/// Any triangle ahead of the column? asks(id) decides where margins do not.
template <class Asks>
HWY_INLINE bool meets_any(const CoverageGrid& grid, const Waiting& w, const Asks& asks, uint64_t& tests) {
  const CoverageReference* reference = grid.references.data() + w.first;
  const CoverageTriangle* triangles = grid.triangles.data();
  const ColumnLanes column(w.x, w.y);
  const auto depth = hn::Set(FourTag(), w.s);
  const uint32_t count = w.count, code = w.code;
  for (uint32_t i = 0; i < count; ++i) {
    if (reference[i].top < code) break;
    const CoverageTriangle& triangle = triangles[reference[i].triangle()];
    const Four lanes = column.at(triangle, depth);
    ++tests;
    if (lanes.at_least(-triangle.margin) != 15) continue;
    if (lanes.above(triangle.margin) == 15 || asks(triangle.id)) return true;
  }
  for (const uint32_t id : grid.near_triangles)
    if (asks(id)) return true;
  return false;
}

struct AnyHit {
  const CoverageGrid& grid;
  const ColumnBatch& batch;
  uint8_t* flags;
  CoverageCounters& counters;

  /// True if the cell tells the answer.
  HWY_INLINE bool decide(const CoverageCell& cell, uint16_t code, uint32_t number) const {
    const bool is_hidden = code < cell.cover;
    if (is_hidden || (code > cell.far && grid.near_triangles.empty())) {
      flags[number] = is_hidden;
      counters.covered += is_hidden;
      counters.free += !is_hidden;
      return true;
    }
    return false;
  }
  static constexpr bool kStartsOutside = false;

  HWY_INLINE void answer(const Waiting& w) const { flags[w.number] = is_hit(w) ? 1 : 0; }

  HWY_INLINE bool is_hit(const Waiting& w) const {
    const auto asks = [&](uint32_t id) {
      ++counters.confirmations;
      Hit hit;
      return confirm(grid, id, batch.rays[w.number], hit);
    };
    return meets_any(grid, w, asks, counters.triangle_tests);
  }
  HWY_INLINE void start(uint32_t) const {}
  HWY_INLINE void miss(uint32_t number) const { flags[number] = 0; }
  HWY_INLINE void finish() const {}
};

/// A cell's references.
struct CellList {
  uint32_t first, count, tile;
};

/// Calls tell(id) for triangles one of which a column that starts before all of them meets first, if any. Returns how
/// many were looked at.
template <class Tell>
HWY_INLINE uint32_t first_hits(const CoverageGrid& grid, float x, float y, const CellList& list, const Tell& tell) {
  struct Candidate {
    uint32_t id;
    float highest;
  };
  constexpr size_t kMostCandidates = 8;
  const CoverageReference* reference = grid.references.data() + list.first;
  const CoverageTriangle* triangles = grid.triangles.data();
  const CoverageTile& tile = grid.tiles[list.tile];
  const ColumnLanes column(x, y);
  Candidate candidates[kMostCandidates];  // NOLINT: filled as far as size says
  size_t size = 0;
  float sure = -kInf;  // the first hit is not below this depth
  int32_t sure_code = 0;
  const auto tell_all = [&] {
    for (size_t c = 0; c < size; ++c)
      if (candidates[c].highest >= sure) tell(candidates[c].id);
    size = 0;
  };
  uint32_t i = 0;
  for (const uint32_t count = list.count; i < count; ++i) {
    if (reference[i].top < sure_code) break;
    const CoverageTriangle& triangle = triangles[reference[i].triangle()];
    const Four lanes = column.at(triangle);
    if ((lanes.at_least(-triangle.margin) & 7) != 7) continue;
    float depth = kInf, radius = 0;
    if (triangle.per_ahead > 0) {  // else it has no plane to speak of
      depth = (triangle.a[3] * x + triangle.b[3] * y + triangle.c[3]) * triangle.per_ahead;
      radius = 2 * triangle.margin * triangle.per_ahead;
      if (depth + radius < sure) continue;
      if (depth - radius > sure && (lanes.above(triangle.margin) & 7) == 7) {
        sure = depth - radius;
        sure_code = code_of(tile, sure) - 2;
      }
    }
    if (size == kMostCandidates) tell_all();
    hwy::Prefetch(grid.mesh->triangles.data() + triangle.id);
    candidates[size++] = {triangle.id, depth + radius};
  }
  tell_all();
  return i;
}

/// The first triangle of a column that starts before all of them.
struct NearestHit {
  const CoverageGrid& grid;
  const ColumnBatch& batch;
  Hit* hits;
  CoverageCounters& counters;
  Confirmations& confirmations;

  static constexpr bool kStartsOutside = true;

  HWY_INLINE void start(uint32_t number) const { hits[number] = {}; }
  HWY_INLINE void miss(uint32_t number) const { hits[number] = {}; }

  HWY_INLINE bool decide(const CoverageCell& cell, uint16_t, uint32_t) const {
    if ((&cell)[1].first != cell.first || !grid.near_triangles.empty()) return false;
    ++counters.free;
    return true;
  }

  HWY_INLINE void answer(const Waiting& w) const {
    for (const uint32_t id : grid.near_triangles) consider(id, w.number);
    const auto tell = [&](uint32_t id) { consider(id, w.number); };
    counters.triangle_tests += first_hits(grid, w.x, w.y, {w.first, w.count, w.tile}, tell);
  }

  HWY_INLINE void consider(uint32_t id, uint32_t number) const {
    ++counters.confirmations;
    if (confirmations.add(id, number)) finish();
  }
  void finish() const { confirmations.decide(*grid.mesh, hits); }
};

/// Answers waiting rays in order; what later ones will read is fetched meanwhile.
template <class Question>
HWY_INLINE void answer_all(const CoverageGrid& grid, const Question& question, const Waiting* waiting, size_t count) {
  constexpr size_t kReferencesAhead = 12, kTrianglesAhead = 5;
  for (size_t i = 0; i < count; ++i) {
    if (i + kReferencesAhead < count) hwy::Prefetch(grid.references.data() + waiting[i + kReferencesAhead].first);
    if (i + kTrianglesAhead < count) {
      const Waiting& w = waiting[i + kTrianglesAhead];
      const CoverageReference* reference = grid.references.data() + w.first;
      for (uint32_t j = 0; j < std::min(w.count, 3u); ++j)
        hwy::Prefetch(grid.triangles.data() + reference[j].triangle());
    }
    question.answer(waiting[i]);
  }
}

/// How a batch is asked.
enum class Order : uint8_t {
  kAsGiven,        // few rays, a small grid, or neighbours that follow each other
  kWaitingByTile,  // cells tell most answers: only the others are sorted
  kPointsByTile,   // all are sorted first
};

struct SortedPoint {
  Vec3 point;
  uint32_t number;
};

/// Scratch space for one batch.
struct Asking {
  Block block;             // NOLINT: filled as far as it is read
  Waiting few[kBlock];     // NOLINT
  uint32_t cells[kBlock];  // NOLINT
  std::vector<SortedPoint> points;
  std::vector<Waiting> waiting;
};

/// Where the groups of a counting sort begin, from counts that are one place up.
inline void sum_up(std::vector<uint32_t>& begin) {
  for (size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
}

inline void sort_by_tile(std::vector<Waiting>& waiting, size_t tiles) {
  std::vector<uint32_t> begin(tiles + 1);
  for (const Waiting& w : waiting) ++begin[w.tile + 1];
  sum_up(begin);
  std::vector<Waiting> sorted(waiting.size());
  for (const Waiting& w : waiting) sorted[begin[w.tile]++] = w;
  waiting.swap(sorted);
}

/// Rays that have no tile come last.
inline void sort_points(const CoverageGrid& grid, const ColumnBatch& batch, Asking& asking) {
  const auto tiles = static_cast<uint32_t>(grid.tiles.size());
  std::vector<uint32_t> begin(tiles + 2), tile_of(batch.count);
  for (size_t first = 0; first < batch.count; first += kBlock) {
    const size_t count = std::min<size_t>(kBlock, batch.count - first);
    load(batch, first, count, asking.block);
    place(grid, batch.rays.kind, count, asking.block);
    for (size_t i = 0; i < count; ++i) {
      tile_of[first + i] = std::min(asking.block.tile[i], tiles);
      ++begin[tile_of[first + i] + 1];
    }
  }
  sum_up(begin);
  asking.points.resize(batch.count);
  for (size_t i = 0; i < batch.count; ++i) {
    const uint32_t number = batch.number(i);
    asking.points[begin[tile_of[i]]++] = {batch.rays.points[number], number};
  }
}

HWY_INLINE void load_sorted(const SortedPoint* points, size_t count, Block& block) {
  for (size_t i = 0; i < count; ++i) {
    block.points[i] = points[i].point;
    block.number[i] = points[i].number;
  }
}

/// Answers what cells tell of a block, and lists the others in asking.few. Returns how many.
template <class Question>
HWY_INLINE size_t ask_cells(const CoverageGrid& grid, ColumnRays::Kind kind, size_t count, const Question& question,
                            Asking& asking, std::vector<uint32_t>& rest) {
  const Block& block = asking.block;
  for (size_t i = 0; i < count; ++i) {
    const uint32_t tile = block.tile[i];
    if (tile >= kBeside) continue;
    asking.cells[i] = cell_at(grid.tiles[tile], block.in_tile_x[i], block.in_tile_y[i]);
    hwy::Prefetch(grid.cells.data() + asking.cells[i]);
  }
  size_t size = 0;
  for (size_t i = 0; i < count; ++i) {
    const uint32_t tile = block.tile[i], number = block.number[i];
    if (tile >= kBeside) {
      if (tile == kBeside)
        question.miss(number);
      else
        rest.push_back(number);
      continue;
    }
    const CoverageCell* cell = &grid.cells[asking.cells[i]];
    const bool is_far = kind == ColumnRays::Kind::kFrom;
    const uint16_t code = is_far ? uint16_t{65535} : code_of(grid.tiles[tile], block.s[i]);
    if (Question::kStartsOutside && !is_far && code <= cell->far) {
      rest.push_back(number);
      continue;
    }
    question.start(number);
    if (question.decide(*cell, code, number)) continue;
    asking.few[size++] = {block.x[i], block.y[i], block.s[i], cell->first, cell[1].first - cell->first, number,
                          tile,       code,       0};
  }
  return size;
}

/// From a few blocks: do most rays fall into the tile of the one before, and do cells tell most answers?
template <class Question>
Order find_order(const CoverageGrid& grid, const ColumnBatch& batch, const Question& question, Asking& asking) {
  constexpr size_t kProbes = 4;
  if (!batch.sorted || batch.count <= 2 * kProbes * kBlock) return Order::kAsGiven;
  size_t same = 0, open = 0;
  std::vector<uint32_t> unwanted;
  const CoverageCounters before = question.counters;
  for (size_t probe = 0; probe < kProbes; ++probe) {
    load(batch, (batch.count - kBlock) / kProbes * probe, kBlock, asking.block);
    place(grid, batch.rays.kind, kBlock, asking.block);
    for (size_t i = 1; i < kBlock; ++i) same += asking.block.tile[i] == asking.block.tile[i - 1];
    open += ask_cells(grid, batch.rays.kind, kBlock, question, asking, unwanted);  // the answers are right
  }
  question.counters = before;  // the rays are asked again
  if (2 * same > kProbes * kBlock) return Order::kAsGiven;
  return 2 * open < kProbes * kBlock ? Order::kWaitingByTile : Order::kPointsByTile;
}

template <class Question>
void ask(const CoverageGrid& grid, const ColumnBatch& batch, const Question& question, std::vector<uint32_t>& rest) {
  Asking asking;
  const Order order = find_order(grid, batch, question, asking);
  if (order == Order::kPointsByTile) sort_points(grid, batch, asking);
  if (order == Order::kWaitingByTile) asking.waiting.reserve(batch.count);
  const size_t rest_begin = rest.size();
  for (size_t begin = 0; begin < batch.count; begin += kBlock) {
    const size_t count = std::min<size_t>(kBlock, batch.count - begin);
    if (order == Order::kPointsByTile)
      load_sorted(asking.points.data() + begin, count, asking.block);
    else
      load(batch, begin, count, asking.block);
    place(grid, batch.rays.kind, count, asking.block);
    const size_t size = ask_cells(grid, batch.rays.kind, count, question, asking, rest);
    if (order == Order::kWaitingByTile)
      asking.waiting.insert(asking.waiting.end(), asking.few, asking.few + size);
    else
      answer_all(grid, question, asking.few, size);
  }
  if (order == Order::kPointsByTile) std::sort(rest.begin() + static_cast<std::ptrdiff_t>(rest_begin), rest.end());
  if (order == Order::kWaitingByTile) {
    sort_by_tile(asking.waiting, grid.tiles.size());
    answer_all(grid, question, asking.waiting.data(), asking.waiting.size());
  }
  question.finish();
}

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

/// What a search of the cell reads first, before it is known that it is read.
HWY_INLINE void fetch_list(const CoverageGrid& grid, const CoverageCell& cell) {
  hwy::Prefetch(grid.references.data() + cell.first);
  hwy::Prefetch(grid.triangles.data() + cell.top);
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
        return confirm(grid, id, ray, hit);
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
    if (confirm(grid, id, ray, hit) && is_nearer(hit, best)) best = hit;
  };
  for (const uint32_t id : grid.near_triangles) consider(id);
  first_hits(grid, column.x, column.y, {cell->first, cell[1].first - cell->first, tile}, consider);
  return best;
}

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
