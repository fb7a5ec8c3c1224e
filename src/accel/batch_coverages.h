// The coverages that are asked about many rays at once, and what such rays share: each is asked about those that it may
// answer.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "raygrain/accelerator.h"

namespace raygrain {

/// Flags of any hits are asked for, or nearest hits.
template <class Answer>
inline constexpr bool kIsAny = std::is_same_v<Answer, uint8_t>;

/// A coverage and the number of its area.
struct AreaCoverage {
  Coverage coverage;
  uint32_t area;
};

/// Those of directions one by one, those about an eye together.
struct BatchCoverages {
  struct Eye {
    Vec3 place;
    std::vector<AreaCoverage> coverages;
  };
  std::vector<AreaCoverage> planes;
  std::vector<Eye> eyes;

  bool is_empty() const { return planes.empty() && eyes.empty(); }
  size_t memory_bytes() const;
  /// Null where no coverage has that eye.
  const Eye* find(Vec3 place) const {
    const auto eye = std::ranges::find(eyes, place, &Eye::place);
    return eye != eyes.end() ? &*eye : nullptr;
  }
};

/// What the rays of a batch share: the direction, or the point where they end (any hits) or start (nearest hits).
struct Shared {
  Vec3 value;
  bool is_point = false;

  /// The ray with its own origin, or its own direction where the start is shared.
  Ray ray(bool any, Vec3 point) const {
    if (!is_point) return {point, value, 0, kInf};
    return any ? Ray{point, value - point, 0, 1} : Ray{value, point, 0, kInf};
  }
};

/// Fewer rays are not worth a batch: that of several coverages about an eye must be divided first. Measured:
/// docs/performance-rays.md, "How many rays a call".
inline constexpr size_t kLeastRays = 5, kLeastDividedRays = 32;

inline size_t least_rays(const BatchCoverages& coverages, const Shared& shared) {
  const BatchCoverages::Eye* eye = shared.is_point ? coverages.find(shared.value) : nullptr;
  return eye != nullptr && eye->coverages.size() > 1 ? kLeastDividedRays : kLeastRays;
}

/// Rays that share something, by number, and where their answers go: flags of any hits or nearest hits.
template <class Answer>
struct SharedRays {
  Shared shared;
  std::span<const Vec3> points;       // origins, or directions from an eye
  std::span<Answer> answers;          // likewise
  std::span<const uint32_t> numbers;  // of the rays that are asked about; without any: all
};

/// Appends the numbers of those that no coverage answers to `rest`. False if there is nobody to ask: nothing is
/// appended then. Counts what is answered.
template <class Answer>
bool ask_coverages(const BatchCoverages& coverages, const SharedRays<Answer>& rays, std::vector<uint32_t>& rest,
                   unsigned threads, AcceleratorCounters* counters);

}  // namespace raygrain
