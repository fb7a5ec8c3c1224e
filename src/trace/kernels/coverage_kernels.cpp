// Compiles the questions to coverage grids for every instruction set.
#define HWY_COMPILE_ALL_ATTAINABLE
// As in kernels.cpp.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/kernels/coverage_kernels.cpp"
#include <hwy/foreach_target.h>
// The one above must come first.
#include <hwy/highway.h>

#include "trace/kernels/coverage-inl.h"
#include "trace/kernels/coverage_kernels.h"
#include "trace/kernels/coverage_single-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

void any(const CoverageGrid& grid, const ColumnBatch& batch, uint8_t* flags, std::vector<uint32_t>& rest,
         CoverageCounters& counters) {
  CoverageCounters counts;
  counts.rays = batch.count;
  ask(grid, batch, AnyHit{grid, batch, flags, counts}, rest);
  counters.add(counts);
}

void nearest(const CoverageGrid& grid, const ColumnBatch& batch, Hit* hits, std::vector<uint32_t>& rest,
             CoverageCounters& counters) {
  CoverageCounters counts;
  counts.rays = batch.count;
  Confirmations confirmations(*grid.mesh, batch.rays, hits);
  ask(grid, batch, NearestHit{grid, batch, hits, counts, confirmations}, rest);
  counters.add(counts);
}

void choose(const EyeGrids& eye, bool are_directions, const Vec3* points, size_t count, uint8_t* chosen) {
  Block block;  // NOLINT: filled as far as it is read
  for (size_t begin = 0; begin < count; begin += kBlock) {
    const size_t size = std::min(kBlock, count - begin);
    std::copy(points + begin, points + begin + size, block.points);
    choose_grids(eye, are_directions, size, block, chosen + begin);
  }
}

std::optional<bool> any_of_one(const CoverageGrid& grid, const SingleColumn& column, const Ray& ray) {
  return single_any(grid, column, ray);
}

std::optional<Hit> nearest_of_one(const CoverageGrid& grid, const SingleColumn& column, const Ray& ray) {
  return single_nearest(grid, column, ray);
}

}  // namespace

extern const CoverageKernels kCoverageTable;
const CoverageKernels kCoverageTable{choose, any_of_one, nearest_of_one, any, nearest};

}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raygrain {

const CoverageKernels& coverage_kernels(Isa isa) {
  switch (isa) {
#if HWY_TARGETS & HWY_SSE4
    case Isa::kSse4:
      return N_SSE4::kCoverageTable;
#endif
#if HWY_TARGETS & HWY_AVX2
    case Isa::kAvx2:
      return N_AVX2::kCoverageTable;
#endif
#if HWY_TARGETS & HWY_AVX3
    case Isa::kAvx512:
      return N_AVX3::kCoverageTable;
#endif
#if HWY_TARGETS & HWY_NEON
    case Isa::kNeon:
      return N_NEON::kCoverageTable;
#endif
    default:
#if HWY_TARGETS & HWY_SCALAR
      return N_SCALAR::kCoverageTable;
#else
      return N_EMU128::kCoverageTable;
#endif
  }
}

}  // namespace raygrain
#endif  // HWY_ONCE
