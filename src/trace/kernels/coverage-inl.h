// Batches of rays and a coverage grid. Many are sorted by cell first, and those of a cell meet its triangles together.
// Of others cells decide what they can; the rest wait, are sorted by tile where there are many, and meet their
// triangles one by one, with a few in flight. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_COVERAGE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_COVERAGE_INL_H
#undef RAYGRAIN_TRACE_KERNELS_COVERAGE_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_COVERAGE_INL_H
#endif

#include <algorithm>
#include <vector>

#include "trace/kernels/coverage_sort-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

/// Scratch space for one batch.
struct Asking {
  Block block;             // NOLINT: filled as far as it is read
  Waiting few[kBlock];     // NOLINT
  uint32_t cells[kBlock];  // NOLINT
  SortedPoints sorted;
  std::vector<Waiting> waiting;
};

HWY_INLINE uint32_t cell_of(const CoverageGrid& grid, const Block& block, size_t i) {
  return cell_at(grid.tiles[block.tile[i]], block.in_tile_x[i], block.in_tile_y[i]);
}

/// The cells of the block's rays; for those without a tile, that instead.
HWY_INLINE void find_cells(const CoverageGrid& grid, size_t count, Asking& asking) {
  for (size_t i = 0; i < count; ++i) {
    const uint32_t tile = asking.block.tile[i];
    asking.cells[i] = tile;
    if (tile >= kBeside) continue;
    asking.cells[i] = cell_of(grid, asking.block, i);
    hwy::Prefetch(grid.cells.data() + asking.cells[i]);
  }
}

/// Answers what cells tell of a block, and lists the others in asking.few. Returns how many.
template <class Question>
HWY_INLINE size_t ask_cells(const CoverageGrid& grid, ColumnRays::Kind kind, size_t count, const Question& question,
                            Asking& asking, std::vector<uint32_t>& rest) {
  const Block& block = asking.block;
  find_cells(grid, count, asking);
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

/// Answers a block whose neighbours are often in one cell.
template <class Question>
HWY_INLINE void ask_runs(const CoverageGrid& grid, size_t count, const Question& question, Asking& asking,
                         std::vector<uint32_t>& rest) {
  constexpr size_t kAhead = 24;
  const Block& block = asking.block;
  find_cells(grid, count, asking);
  for (size_t i = 0, end = 0; i < count; i = end) {
    if (i + kAhead < count && block.tile[i + kAhead] < kBeside) fetch_list(grid, grid.cells[asking.cells[i + kAhead]]);
    const uint32_t cell = asking.cells[i], tile = block.tile[i];
    const size_t most = std::min(count, i + kPacket);
    for (end = i + 1; end < most && asking.cells[end] == cell;) ++end;
    if (tile < kBeside) {
      question.answer_together(Packet(block, i, end - i), block.number + i, grid.cells[cell], grid.tiles[tile], rest);
    } else if (tile == kBeside) {
      for (size_t j = i; j < end; ++j) question.miss(block.number[j]);
    } else {
      rest.insert(rest.end(), block.number + i, block.number + end);
    }
  }
}

/// From a few blocks: do most rays fall into the cell or the tile of the one before, and do cells tell most answers?
template <class Question>
CoverageOrder find_order(const CoverageGrid& grid, const ColumnBatch& batch, const Question& question, Asking& asking) {
  constexpr size_t kProbes = 4, kProbed = kProbes * kBlock;
  constexpr size_t kPerCellWhereTold = 16, kPerCellWhereInOrder = 5;
  const size_t per_cell = batch.count / grid.cells.size();
  if (batch.by_cell && Question::kStartsOutside && per_cell >= kPerCellWhereInOrder) return CoverageOrder::kByCell;
  if (batch.count <= kProbed || !(batch.by_cell || batch.by_tile)) return CoverageOrder::kAsGiven;
  size_t same_cell = 0, same_tile = 0, placed = 0, open = 0;
  std::vector<uint32_t> unwanted;
  const CoverageCounters before = question.counters;
  for (size_t probe = 0; probe < kProbes; ++probe) {
    load(batch, (batch.count - kBlock) / kProbes * probe, kBlock, asking.block);
    place(grid, batch.rays.kind, kBlock, asking.block);
    open += ask_cells(grid, batch.rays.kind, kBlock, question, asking, unwanted);  // the answers are right
    for (size_t i = 1; i < kBlock; ++i) {
      const bool is_placed = asking.block.tile[i] < kBeside;
      placed += is_placed;
      same_cell += is_placed && asking.cells[i] == asking.cells[i - 1];
      same_tile += asking.block.tile[i] == asking.block.tile[i - 1];
    }
  }
  question.counters = before;  // the rays are asked again
  const bool are_told = !Question::kStartsOutside && 2 * open < kProbed;
  const bool are_in_order = 2 * same_tile > kProbed;
  const size_t enough = are_told ? kPerCellWhereTold : are_in_order ? kPerCellWhereInOrder : 0;
  if (batch.by_cell && per_cell >= enough) return CoverageOrder::kByCell;
  if (are_in_order || !batch.by_tile) return 2 * same_cell > placed ? CoverageOrder::kRuns : CoverageOrder::kAsGiven;
  return are_told ? CoverageOrder::kOpenByTile : CoverageOrder::kByTile;
}

/// So many waiting rays fit a cache.
constexpr size_t kMostWaiting = size_t{1} << 17;

template <class Question>
void answer_waiting(const CoverageGrid& grid, const Question& question, std::vector<Waiting>& waiting) {
  if (waiting.empty()) return;
  sort_by_tile(waiting, grid.tiles.size());
  answer_all(grid, question, waiting.data(), waiting.size());
  waiting.clear();
}

template <class Question>
void ask_blocks(const CoverageGrid& grid, const ColumnBatch& batch, CoverageOrder order, const Question& question,
                Asking& asking, std::vector<uint32_t>& rest) {
  for (size_t begin = 0; begin < batch.count; begin += kBlock) {
    const size_t count = std::min<size_t>(kBlock, batch.count - begin);
    if (order == CoverageOrder::kByTile)
      load_sorted(asking.sorted.points.data() + begin, count, question, asking.block);
    else
      load(batch, begin, count, asking.block);
    place(grid, batch.rays.kind, count, asking.block);
    if (order == CoverageOrder::kRuns) {
      ask_runs(grid, count, question, asking, rest);
      continue;
    }
    const size_t size = ask_cells(grid, batch.rays.kind, count, question, asking, rest);
    if (order != CoverageOrder::kOpenByTile) {
      answer_all(grid, question, asking.few, size);
      continue;
    }
    asking.waiting.insert(asking.waiting.end(), asking.few, asking.few + size);
    if (asking.waiting.size() >= kMostWaiting) answer_waiting(grid, question, asking.waiting);
  }
  answer_waiting(grid, question, asking.waiting);
}

template <class Question>
void ask(const CoverageGrid& grid, const ColumnBatch& batch, const Question& question, std::vector<uint32_t>& rest) {
  Asking asking;
  const CoverageOrder order =
      batch.order == CoverageOrder::kChosen ? find_order(grid, batch, question, asking) : batch.order;
  const size_t rest_begin = rest.size();
  if (order == CoverageOrder::kByCell) {
    const auto by_cell = [&](const Block& block, size_t i) { return cell_of(grid, block, i); };
    sort_points(grid, batch, grid.cells.size(), by_cell, asking.block, asking.sorted);
    ask_by_cell(grid, batch, question, asking.sorted, rest);
  } else {
    const auto by_tile = [](const Block& block, size_t i) { return block.tile[i]; };
    if (order == CoverageOrder::kByTile)
      sort_points(grid, batch, grid.tiles.size(), by_tile, asking.block, asking.sorted);
    ask_blocks(grid, batch, order, question, asking, rest);
  }
  if (order == CoverageOrder::kByCell || order == CoverageOrder::kByTile)
    std::sort(rest.begin() + static_cast<std::ptrdiff_t>(rest_begin), rest.end());
  question.finish();
}

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
