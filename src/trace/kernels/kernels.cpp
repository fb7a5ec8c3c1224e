// Compiles the searches for every instruction set and finds what the CPU can run.
#define HWY_COMPILE_ALL_ATTAINABLE
// Scalar code instead of SSSE3; the scalable vectors of Arm have no constant width.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/kernels/kernels.cpp"
#include <hwy/foreach_target.h>
// The one above must come first.
#include <algorithm>
#include <cmath>

#include <hwy/highway.h>

#include "trace/kernels/any_stream-inl.h"
#include "trace/kernels/kernels.h"
#include "trace/kernels/nearest_stream-inl.h"
#include "trace/kernels/searches-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

Hit nearest_of_one(const WideTree& tree, const Ray& ray, Hit known, float skip_before) {
  return nearest<false, true>(tree, ray, known, skip_before, nullptr);
}

bool any_of_one(const WideTree& tree, const Ray& ray, float skip_before) {
  return any<false, true>(tree, ray, skip_before, nullptr);
}

Hit nearest_counted(const WideTree& tree, const Ray& ray, Hit known, const SearchOptions& options,
                    TraceCounters& counters) {
  return options.prune ? nearest<true, true>(tree, ray, known, options.skip_before, &counters)
                       : nearest<true, false>(tree, ray, known, options.skip_before, &counters);
}

bool any_counted(const WideTree& tree, const Ray& ray, const SearchOptions& options, TraceCounters& counters) {
  return options.prune ? any<true, true>(tree, ray, options.skip_before, &counters)
                       : any<true, false>(tree, ray, options.skip_before, &counters);
}

/// Do neighbours in the list go almost the same way? Their branches are easy to predict then, and a ray alone does less
/// work than one in a stream. From a few of them.
bool are_in_order(const WideTree& tree, const Ray* rays, size_t count) {
  constexpr size_t kPairs = 8;
  constexpr float kNear = 0x1p-6f;
  if (count < 2 * kPairs) return false;
  const auto largest = [](Vec3 a) { return std::max(std::max(std::abs(a.x), std::abs(a.y)), std::abs(a.z)); };
  for (size_t i = 0; i < kPairs; ++i) {
    const Ray* ray = rays + (count - 1) / kPairs * i;
    if (!(largest(ray[1].direction - ray->direction) <= kNear * largest(ray->direction))) return false;
    if (!(largest(ray[1].origin - ray->origin) <= kNear * tree.reach)) return false;
  }
  return true;
}

void nearest_of_many(const WideTree& tree, const Ray* rays, Hit* hits, size_t count) {
  if (kHasStreams && !are_in_order(tree, rays, count)) return NearestStream(tree, rays, hits, count).run();
  for (size_t i = 0; i < count; ++i) hits[i] = nearest<false, true>(tree, rays[i], {}, -kInf, nullptr);
}

void any_of_many(const WideTree& tree, const Ray* rays, uint8_t* flags, size_t count) {
  if constexpr (kHasStreams) return AnyStream(tree, rays, flags, count).run();
  for (size_t i = 0; i < count; ++i) flags[i] = any<false, true>(tree, rays[i], -kInf, nullptr) ? 1 : 0;
}

}  // namespace

extern const Kernels kTable;
const Kernels kTable{nearest_of_one, any_of_one, nearest_counted, any_counted, nearest_of_many, any_of_many};

}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raygrain {
namespace {

#if HWY_ARCH_X86
bool cpu_has_sse4() {
  return __builtin_cpu_supports("sse4.1") && __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("pclmul") &&
         __builtin_cpu_supports("aes");
}
bool cpu_has_avx2() {
  return cpu_has_sse4() && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
         __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
}
bool cpu_has_avx512() {
  return cpu_has_avx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
}
#endif

}  // namespace

const Kernels* kernels(Isa isa) {
  switch (isa) {
    case Isa::kScalar:
#if HWY_TARGETS & HWY_SCALAR
      return &N_SCALAR::kTable;
#else
      return &N_EMU128::kTable;
#endif
    case Isa::kSse4:
#if HWY_TARGETS & HWY_SSE4
      if (cpu_has_sse4()) return &N_SSE4::kTable;
#endif
      return nullptr;
    case Isa::kAvx2:
#if HWY_TARGETS & HWY_AVX2
      if (cpu_has_avx2()) return &N_AVX2::kTable;
#endif
      return nullptr;
    case Isa::kAvx512:
#if HWY_TARGETS & HWY_AVX3
      if (cpu_has_avx512()) return &N_AVX3::kTable;
#endif
      return nullptr;
    case Isa::kNeon:
#if HWY_TARGETS & HWY_NEON
      return &N_NEON::kTable;
#else
      return nullptr;
#endif
  }
  return nullptr;
}

}  // namespace raygrain
#endif  // HWY_ONCE
