// Batches of rays and a coverage grid. Cells decide what they can; the others wait, are sorted by tile where there are
// many, and meet their triangles, a few of them in flight at a time. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_COVERAGE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_COVERAGE_INL_H
#undef RAYGRAIN_TRACE_KERNELS_COVERAGE_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_COVERAGE_INL_H
#endif

#include <algorithm>
#include <array>
#include <vector>

#include "trace/kernels/coverage_questions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

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
    const bool is_told = question.decide(*cell, code, number);
    if (Question::kJumps && is_told) continue;
    asking.few[size] = {block.x[i], block.y[i], block.s[i], cell->first, cell[1].first - cell->first, number,
                        tile,       code,       0};
    size += is_told ? 0 : 1;
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

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
