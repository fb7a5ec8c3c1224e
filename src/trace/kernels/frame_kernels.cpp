// Compiles the searches in ray space for every instruction set.
#define HWY_COMPILE_ALL_ATTAINABLE
// As in kernels.cpp.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/kernels/frame_kernels.cpp"
#include <hwy/foreach_target.h>
// The one above must come first.
#include <hwy/highway.h>

#include "trace/kernels/frame_kernels.h"
#include "trace/kernels/frame_searches-inl.h"
#include "trace/kernels/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

template <bool kCounting, bool kPruning>
Hit nearest(const FrameMemory& tree, const FrameQuery& query, FrameUse use, const Ray& ray, const Hit& known,
            TraceCounters* counters) {
  if (use == FrameUse::kColumn)
    return query.column.ascending ? nearest_in_frame<ColumnBoxes, ColumnTriangles, true, kCounting, kPruning>(
                                        tree, query, ray, known, counters)
                                  : nearest_in_frame<ColumnBoxes, ColumnTriangles, false, kCounting, kPruning>(
                                        tree, query, ray, known, counters);
  return query.column.ascending
             ? nearest_in_frame<ConeBoxes, ConeTriangles, true, kCounting, kPruning>(tree, query, ray, known, counters)
             : nearest_in_frame<ConeBoxes, ConeTriangles, false, kCounting, kPruning>(tree, query, ray, known,
                                                                                      counters);
}

template <bool kCounting, bool kPruning>
bool any(const FrameMemory& tree, const FrameQuery& query, FrameUse use, const Ray& ray, TraceCounters* counters) {
  return use == FrameUse::kColumn
             ? any_in_frame<ColumnBoxes, ColumnTriangles, kCounting, kPruning>(tree, query, ray, counters)
             : any_in_frame<ConeBoxes, ConeTriangles, kCounting, kPruning>(tree, query, ray, counters);
}

Hit nearest_of_one(const FrameMemory& tree, const FrameQuery& query, FrameUse use, const Ray& ray, const Hit& known) {
  return nearest<false, true>(tree, query, use, ray, known, nullptr);
}
bool any_of_one(const FrameMemory& tree, const FrameQuery& query, FrameUse use, const Ray& ray) {
  return any<false, true>(tree, query, use, ray, nullptr);
}
Hit nearest_counted(const FrameMemory& tree, const FrameQuery& query, FrameUse use, const Ray& ray, const Hit& known,
                    bool prune, TraceCounters& counters) {
  return prune ? nearest<true, true>(tree, query, use, ray, known, &counters)
               : nearest<true, false>(tree, query, use, ray, known, &counters);
}
bool any_counted(const FrameMemory& tree, const FrameQuery& query, FrameUse use, const Ray& ray, bool prune,
                 TraceCounters& counters) {
  return prune ? any<true, true>(tree, query, use, ray, &counters) : any<true, false>(tree, query, use, ray, &counters);
}

}  // namespace

extern const FrameKernels kFrameTable;
const FrameKernels kFrameTable{nearest_of_one, any_of_one, nearest_counted, any_counted};

}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raygrain {

const FrameKernels* frame_kernels(Isa isa) {
  if (kernels(isa) == nullptr) return nullptr;  // the CPU lacks it
  switch (isa) {
    case Isa::kScalar:
#if HWY_TARGETS & HWY_SCALAR
      return &N_SCALAR::kFrameTable;
#else
      return &N_EMU128::kFrameTable;
#endif
#if HWY_TARGETS & HWY_SSE4
    case Isa::kSse4:
      return &N_SSE4::kFrameTable;
#endif
#if HWY_TARGETS & HWY_AVX2
    case Isa::kAvx2:
      return &N_AVX2::kFrameTable;
#endif
#if HWY_TARGETS & HWY_AVX3
    case Isa::kAvx512:
      return &N_AVX3::kFrameTable;
#endif
#if HWY_TARGETS & HWY_NEON
    case Isa::kNeon:
      return &N_NEON::kFrameTable;
#endif
    default:
      return nullptr;
  }
}

}  // namespace raygrain
#endif  // HWY_ONCE
