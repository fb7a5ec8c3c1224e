// Rays of a batch in the order of tiles or cells, so that they share what they read. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_COVERAGE_SORT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_COVERAGE_SORT_INL_H
#undef RAYGRAIN_TRACE_KERNELS_COVERAGE_SORT_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_COVERAGE_SORT_INL_H
#endif

#include <algorithm>
#include <vector>

#include <hwy/cache_control.h>

#include "trace/kernels/coverage_questions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

struct SortedPoint {
  Vec3 point;
  uint32_t number;
};
static_assert(sizeof(SortedPoint) == 16);

/// Points in groups.
struct SortedPoints {
  std::vector<SortedPoint> points;  // and room for those that are read ahead
  std::vector<uint32_t> ends;       // of groups
};

/// Answers of so many rays ahead are fetched before they are written.
constexpr size_t kAnswersAhead = 64;

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

/// By group(block, i) in 0 ... groups - 1. Rays that have no tile come after them: in group `groups` where nothing is,
/// in the next all others.
template <class Group>
void sort_points(const CoverageGrid& grid, const ColumnBatch& batch, size_t groups, const Group& group, Block& block,
                 SortedPoints& sorted) {
  std::vector<uint32_t> group_of(batch.count);
  std::vector<uint32_t>& ends = sorted.ends;
  ends.assign(groups + 3, 0);
  for (size_t first = 0; first < batch.count; first += kBlock) {
    const size_t count = std::min<size_t>(kBlock, batch.count - first);
    load(batch, first, count, block);
    place(grid, batch.rays.kind, count, block);
    for (size_t i = 0; i < count; ++i) {
      const uint32_t tile = block.tile[i];
      const uint32_t g = tile < kBeside ? group(block, i) : static_cast<uint32_t>(groups) + (tile == kBeside ? 0 : 1);
      group_of[first + i] = g;
      ++ends[g + 1];
    }
  }
  sum_up(ends);
  sorted.points.resize(batch.count + kPacket + kAnswersAhead);
  for (size_t i = 0; i < batch.count; ++i) {
    const uint32_t number = batch.number(i);
    sorted.points[ends[group_of[i]]++] = {batch.rays.points[number], number};
  }
}

template <class Question>
HWY_INLINE void load_sorted(const SortedPoint* points, size_t count, const Question& question, Block& block) {
  for (size_t i = 0; i < count; ++i) {
    question.fetch(points[i].number);
    block.points[i] = points[i].point;
    block.number[i] = points[i].number;
  }
}

/// Rays sorted by cell, as many of a cell at once as a vector holds.
template <class Question>
void ask_by_cell(const CoverageGrid& grid, const ColumnBatch& batch, const Question& question,
                 const SortedPoints& sorted, std::vector<uint32_t>& rest) {
  const ColumnTag d;
  const hn::RebindToUnsigned<ColumnTag> du;
  const Vec3 center = center_of(grid, batch.rays.kind);
  uint32_t at = 0;
  for (const CoverageTile& tile : grid.tiles)
    for (uint32_t c = tile.first_cell; c < tile.first_cell + tile.across * tile.across; ++c) {
      fetch_list(grid, grid.cells[std::min<size_t>(c + 6, grid.cells.size() - 1)]);
      for (const uint32_t end = sorted.ends[c]; at < end;) {
        const SortedPoint* points = sorted.points.data() + at;
        const size_t count = std::min<size_t>(kPacket, end - at);
        ColumnFloats px, py, pz, numbers;
        hn::LoadInterleaved4(d, &points->point.x, px, py, pz, numbers);
        alignas(64) uint32_t number[kPacket];
        hn::Store(hn::BitCast(du, numbers), du, number);
        for (size_t i = 0; i < count; ++i) question.fetch(points[kAnswersAhead + i].number);
        const ColumnVectors columns(grid, MapPoints(center, px, py, pz));
        question.answer_together(Packet(columns, px, py, pz, count), number, grid.cells[c], tile, rest);
        at += static_cast<uint32_t>(count);
      }
    }
  const size_t cells = grid.cells.size();
  for (; at < sorted.ends[cells]; ++at) question.miss(sorted.points[at].number);
  for (; at < batch.count; ++at) rest.push_back(sorted.points[at].number);
}

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
