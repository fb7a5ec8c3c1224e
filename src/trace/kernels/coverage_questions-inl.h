// The two questions to a coverage grid, any hit and nearest hit: what a cell tells, and what its triangles do. Included
// once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_COVERAGE_QUESTIONS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_COVERAGE_QUESTIONS_INL_H
#undef RAYGRAIN_TRACE_KERNELS_COVERAGE_QUESTIONS_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_COVERAGE_QUESTIONS_INL_H
#endif

#include <algorithm>
#include <cmath>

#include <hwy/cache_control.h>

#include "raygrain/triangle.h"

#include "trace/kernels/coverage_packets-inl.h"
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

/// What a search of the cell reads first, before it is known that it is read.
HWY_INLINE void fetch_list(const CoverageGrid& grid, const CoverageCell& cell) {
  hwy::Prefetch(grid.references.data() + cell.first);
  hwy::Prefetch(grid.triangles.data() + cell.top);
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
  bool has_no_near = grid.near_triangles.empty();

  /// True if the cell tells the answer.
  HWY_INLINE bool decide(const CoverageCell& cell, uint16_t code, uint32_t number) const {
    const bool is_hidden = code < cell.cover;
    const bool is_free = (code > cell.far) & has_no_near & !is_hidden;
    flags[number] = is_hidden;  // or what will be written later
    counters.covered += is_hidden;
    counters.free += is_free;
    return is_hidden | is_free;
  }
  static constexpr bool kStartsOutside = false;
  static constexpr bool kJumps = false;  // over what cells tell: nobody can guess which do

  HWY_INLINE void answer(const Waiting& w) const { flags[w.number] = is_hit(w) ? 1 : 0; }

  /// Rays in one cell, by their numbers.
  HWY_INLINE void answer_together(const Packet& packet, const uint32_t* numbers, const CoverageCell& cell,
                                  const CoverageTile& tile, std::vector<uint32_t>&) const {
    const ColumnFloats codes = codes_of(tile, packet.s);
    const uint32_t hidden = packet.lanes & bits_of(hn::Lt(codes, broadcast_column(cell.cover)));
    const uint32_t above = packet.lanes & bits_of(hn::Gt(codes, broadcast_column(cell.far))) & ~hidden;
    const uint32_t free = has_no_near ? above : 0;
    counters.covered += static_cast<uint64_t>(std::popcount(hidden));
    counters.free += static_cast<uint64_t>(std::popcount(free));
    const auto asks = [&](uint32_t id, size_t lane) {
      ++counters.confirmations;
      Hit hit;
      return confirm(batch.rays[numbers[lane]], *grid.mesh, id, hit);
    };
    const uint32_t open = packet.lanes & ~(hidden | free);
    uint32_t met = hidden;
    if (open != 0) met |= meet_any(grid, packet, cell, codes, open, asks, counters.triangle_tests);
    for (const uint32_t id : grid.near_triangles)
      for (uint32_t undecided = open & ~met; undecided != 0; undecided &= undecided - 1) {
        const auto lane = static_cast<size_t>(std::countr_zero(undecided));
        if (asks(id, lane)) met |= 1u << lane;
      }
    const auto count = static_cast<size_t>(std::popcount(packet.lanes));
    for (size_t lane = 0; lane < count; ++lane) flags[numbers[lane]] = met >> lane & 1;
  }

  HWY_INLINE bool is_hit(const Waiting& w) const {
    const auto asks = [&](uint32_t id) {
      ++counters.confirmations;
      Hit hit;
      return confirm(batch.rays[w.number], *grid.mesh, id, hit);
    };
    return meets_any(grid, w, asks, counters.triangle_tests);
  }
  HWY_INLINE void fetch(uint32_t number) const { hwy::Prefetch(flags + number); }
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
  bool has_no_near = grid.near_triangles.empty();

  static constexpr bool kStartsOutside = true;
  static constexpr bool kJumps = true;

  HWY_INLINE void fetch(uint32_t number) const { hwy::Prefetch(hits + number); }
  HWY_INLINE void start(uint32_t number) const { hits[number] = {}; }
  HWY_INLINE void miss(uint32_t number) const { hits[number] = {}; }

  HWY_INLINE bool decide(const CoverageCell& cell, uint16_t, uint32_t) const {
    const bool is_free = ((&cell)[1].first == cell.first) & has_no_near;
    counters.free += is_free;
    return is_free;
  }

  HWY_INLINE void answer(const Waiting& w) const {
    for (const uint32_t id : grid.near_triangles) consider(id, w.number);
    const auto tell = [&](uint32_t id) { consider(id, w.number); };
    counters.triangle_tests += first_hits(grid, w.x, w.y, {w.first, w.count, w.tile}, tell);
  }

  /// Rays in one cell, by their numbers. Those that do not start outside join the rest.
  HWY_INLINE void answer_together(const Packet& packet, const uint32_t* numbers, const CoverageCell& cell,
                                  const CoverageTile& tile, std::vector<uint32_t>& rest) const {
    uint32_t lanes = packet.lanes;
    if (batch.rays.kind != ColumnRays::Kind::kFrom) {
      const uint32_t below = lanes & bits_of(hn::Le(codes_of(tile, packet.s), broadcast_column(cell.far)));
      for (uint32_t bits = below; bits != 0; bits &= bits - 1) rest.push_back(numbers[std::countr_zero(bits)]);
      lanes &= ~below;
    }
    for (uint32_t bits = lanes; bits != 0; bits &= bits - 1) hits[numbers[std::countr_zero(bits)]] = {};
    if ((&cell)[1].first == cell.first && has_no_near) {
      counters.free += static_cast<uint64_t>(std::popcount(lanes));
      return;
    }
    for (const uint32_t id : grid.near_triangles)
      for (uint32_t bits = lanes; bits != 0; bits &= bits - 1) consider(id, numbers[std::countr_zero(bits)]);
    const FirstHits found = find_first(grid, packet, lanes, cell, tile, counters.triangle_tests);
    counters.confirmations += static_cast<uint64_t>(std::popcount(found.one));
    confirmations.add(packet, found.ids, numbers, found.one);
    if (found.several != 0) answer_apart(packet, found.several, numbers, cell, tile);
  }

  /// Columns one by one whose first hit is one of several.
  HWY_NOINLINE void answer_apart(const Packet& packet, uint32_t lanes, const uint32_t* numbers,
                                 const CoverageCell& cell, const CoverageTile& tile) const {
    const CellList list{cell.first, (&cell)[1].first - cell.first, static_cast<uint32_t>(&tile - grid.tiles.data())};
    alignas(64) float x[kPacket], y[kPacket];
    hn::Store(packet.x, ColumnTag(), x);
    hn::Store(packet.y, ColumnTag(), y);
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<size_t>(std::countr_zero(lanes));
      const auto tell = [&](uint32_t id) { consider(id, numbers[lane]); };
      first_hits(grid, x[lane], y[lane], list, tell);
    }
  }

  HWY_INLINE void consider(uint32_t id, uint32_t number) const {
    ++counters.confirmations;
    confirmations.add(id, number);
  }
  void finish() const { confirmations.decide(); }
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

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
