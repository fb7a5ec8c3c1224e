#include "trace/coverage_divide.h"

#include <array>

#include "base/parallel.h"

namespace raygrain {
namespace {

constexpr size_t kPointsPerTask = size_t{1} << 14;

/// Of the points of one task: how many are each grid's, then where the next of these goes. Fewer than 2^32.
using Places = std::array<uint32_t, 256>;

template <class Body>
void for_tasks(size_t points, unsigned threads, const Body& body) {
  parallel_for(points, kPointsPerTask, threads,
               [&](size_t begin, size_t end) { body(begin / kPointsPerTask, begin, end); });
}

/// Calls body(grid), of those that there are, and of none: small batches do not wait for sums of all that a byte can
/// name.
template <class Body>
void for_grids(const EyeGrids& eye, const Body& body) {
  for (size_t grid = 0; grid < eye.count; ++grid) body(grid);
  body(size_t{kNoGrid});
}

/// From counts to places, task after task. Returns the sums.
Places sum_up(const EyeGrids& eye, std::vector<Places>& tasks) {
  Places sums{};
  for (Places& places : tasks)
    for_grids(eye, [&](size_t grid) {
      const uint32_t count = places[grid];
      places[grid] = sums[grid];
      sums[grid] += count;
    });
  return sums;
}

}  // namespace

std::vector<std::vector<uint32_t>> divide_points(const EyeGrids& eye, const CoverageKernels& kernels,
                                                 std::span<const Vec3> points, bool are_directions,
                                                 std::vector<uint32_t>& rest, unsigned threads) {
  std::vector<uint8_t> chosen(points.size());
  std::vector<Places> tasks((points.size() + kPointsPerTask - 1) / kPointsPerTask);
  for_tasks(points.size(), threads, [&](size_t task, size_t begin, size_t end) {
    kernels.choose(eye, are_directions, points.data() + begin, end - begin, chosen.data() + begin);
    Places& counts = tasks[task];
    for (size_t i = begin; i < end; ++i) ++counts[chosen[i]];
  });
  const Places sums = sum_up(eye, tasks);
  std::vector<std::vector<uint32_t>> lists(eye.count);
  std::array<uint32_t*, 256> first{};
  for (size_t grid = 0; grid < lists.size(); ++grid) {
    lists[grid].resize(sums[grid]);
    first[grid] = lists[grid].data();
  }
  rest.resize(rest.size() + sums[kNoGrid]);
  first[kNoGrid] = rest.data() + rest.size() - sums[kNoGrid];
  for_tasks(points.size(), threads, [&](size_t task, size_t begin, size_t end) {
    std::array<uint32_t*, 256> next;
    for_grids(eye, [&](size_t grid) { next[grid] = first[grid] + tasks[task][grid]; });
    for (size_t i = begin; i < end; ++i) *next[chosen[i]]++ = static_cast<uint32_t>(i);
  });
  return lists;
}

}  // namespace raygrain
