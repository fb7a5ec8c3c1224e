// The two questions to a coverage grid. Cells decide what they can; the others wait, are sorted by tile where there are
// many, and meet their triangles, a few of them in flight at a time. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_COVERAGE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_COVERAGE_INL_H
#undef RAYGRAIN_TRACE_KERNELS_COVERAGE_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_COVERAGE_INL_H
#endif

#include <array>

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
  for (uint32_t i = 0; i < w.count; ++i) {
    if (reference[i].top < w.code) break;
    const CoverageTriangle& triangle = grid.triangles[reference[i].triangle()];
    const Verdict verdict = meet(triangle, w.x, w.y, w.s);
    ++tests;
    if (verdict.possible != 15) continue;
    if (verdict.sure == 15 || asks(triangle.id)) return true;
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
  for (; i < list.count; ++i) {
    if (reference[i].top < sure_code) break;
    const CoverageTriangle& triangle = grid.triangles[reference[i].triangle()];
    const Verdict verdict = meet(triangle, x, y, 0);
    if ((verdict.possible & 7) != 7) continue;
    float depth = kInf, radius = 0;
    if (triangle.ahead < 0) {  // else it has no plane to speak of
      const float per_ahead = -1 / triangle.ahead;
      depth = (triangle.a[3] * x + triangle.b[3] * y + triangle.c[3]) * per_ahead;
      radius = 2 * triangle.margin * per_ahead;
      if (depth + radius < sure) continue;
      if ((verdict.sure & 7) == 7 && depth - radius > sure) {
        sure = depth - radius;
        sure_code = code_of(grid.tiles[list.tile], sure) - 2;
      }
    }
    if (size == kMostCandidates) tell_all();
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
  void finish() const {
    confirmations.decide(
        *grid.mesh, batch.rays,
        [this](uint32_t number) {
          hwy::Prefetch(batch.rays.points + number);
          hwy::Prefetch(hits + number);
        },
        [this](uint32_t number, const Hit& hit) {
          if (is_nearer(hit, hits[number])) hits[number] = hit;
        });
  }
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
  question.finish();
}

/// Counting sort by tile.
inline void sort_by_tile(std::vector<Waiting>& waiting, size_t tiles, std::vector<uint32_t>& begin,
                         std::vector<Waiting>& sorted) {
  begin.assign(tiles + 1, 0);
  for (const Waiting& w : waiting) ++begin[w.tile + 1];
  for (size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  sorted.resize(waiting.size());
  for (const Waiting& w : waiting) sorted[begin[w.tile]++] = w;
  waiting.swap(sorted);
}

/// Do most rays fall into the tile of the one before? Told from a few blocks.
inline bool are_coherent(const CoverageGrid& grid, const ColumnBatch& batch, Block& block) {
  constexpr size_t kProbes = 4;
  size_t same = 0;
  for (size_t probe = 0; probe < kProbes; ++probe) {
    place(grid, batch, (batch.count - kBlock) / kProbes * probe, kBlock, block);
    for (size_t i = 1; i < kBlock; ++i) same += block.tile[i] == block.tile[i - 1];
  }
  return 2 * same > kProbes * kBlock;
}

template <class Question>
void ask(const CoverageGrid& grid, const ColumnBatch& batch, const Question& question, std::vector<uint32_t>& rest,
         CoverageCounters& counters) {
  Block block;  // NOLINT: filled as far as it is read
  std::vector<Waiting> waiting;
  const bool sorts = batch.sorted && batch.count > 4 * kBlock && !are_coherent(grid, batch, block);
  if (sorts) waiting.reserve(batch.count);
  std::array<Waiting, kBlock> few;     // NOLINT
  std::array<uint32_t, kBlock> cells;  // NOLINT
  counters.rays += batch.count;
  for (size_t begin = 0; begin < batch.count; begin += kBlock) {
    const size_t count = std::min<size_t>(kBlock, batch.count - begin);
    place(grid, batch, begin, count, block);
    for (size_t i = 0; i < count; ++i) {
      const uint32_t tile = block.tile[i];
      if (tile >= kBeside) continue;
      cells[i] = cell_at(grid.tiles[tile], block.in_tile_x[i], block.in_tile_y[i]);
      hwy::Prefetch(grid.cells.data() + cells[i]);
    }
    size_t size = 0;
    for (size_t i = 0; i < count; ++i) {
      const uint32_t tile = block.tile[i], number = block.number[i];
      if (tile == kOutside) {
        rest.push_back(number);
        continue;
      }
      if (tile == kBeside) {
        question.miss(number);
        continue;
      }
      const CoverageCell& cell = grid.cells[cells[i]];
      const bool is_far = batch.rays.kind == ColumnRays::Kind::kFrom;
      const uint16_t code = is_far ? uint16_t{65535} : code_of(grid.tiles[tile], block.s[i]);
      if (Question::kStartsOutside && !is_far && code <= cell.far) {
        rest.push_back(number);
        continue;
      }
      question.start(number);
      if (question.decide(cell, code, number)) continue;
      few[size++] = {block.x[i], block.y[i], block.s[i], cell.first, (&cell)[1].first - cell.first,
                     number,     tile,       code,       0};
    }
    if (sorts)
      waiting.insert(waiting.end(), few.begin(), few.begin() + static_cast<std::ptrdiff_t>(size));
    else
      answer_all(grid, question, few.data(), size);
  }
  if (!sorts) return;
  std::vector<uint32_t> tiles;
  std::vector<Waiting> sorted;
  sort_by_tile(waiting, grid.tiles.size(), tiles, sorted);
  answer_all(grid, question, waiting.data(), waiting.size());
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

inline std::optional<bool> single_any(const CoverageGrid& grid, const SingleColumn& column, const Ray& ray) {
  uint32_t tile = 0, number = 0;
  if (!find_cell(grid, column, tile, number)) return {};
  const CoverageCell* cell = &grid.cells[number];
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
  if (!find_cell(grid, column, tile, number)) return {};
  const CoverageCell* cell = &grid.cells[number];
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
