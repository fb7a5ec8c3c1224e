// Whose each ray is, of several coverages about one eye.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raygrain/vec.h"

#include "trace/kernels/coverage_kernels.h"

namespace raygrain {

/// A list for each grid of the points (or directions) in its window, ascending; the numbers of all others are appended
/// to `rest`. The same for any number of threads (0 = all).
std::vector<std::vector<uint32_t>> divide_points(const EyeGrids& eye, const CoverageKernels& kernels,
                                                 std::span<const Vec3> points, bool are_directions,
                                                 std::vector<uint32_t>& rest, unsigned threads);

}  // namespace raygrain
