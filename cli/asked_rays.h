// Given rays asked of an accelerator, and its answers checked against brute force.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "raygrain/accelerator.h"

namespace raygrain::cli {

/// Told which share is done, in [0, 1].
using Tell = std::function<void(double done)>;

/// In the order of the rays.
struct RayAnswers {
  std::vector<Hit> hits;       // where nearest hits were asked for
  std::vector<uint8_t> flags;  // ... or else any: 1 is a hit
  AcceleratorCounters counters;
  double seconds = 0;

  size_t hit_count() const;
};
RayAnswers ask_rays(const Accelerator& accelerator, std::span<const Ray> rays, bool any, unsigned threads,
                    const Tell& tell);

/// One way to ask all rays: each was asked twice, with counters and without.
struct CheckedQuestion {
  AreaQuestion question;
  AcceleratorCounters counters = {};  // of the one time
  uint64_t differences = 0;           // rays that brute force answers otherwise
};
struct CheckedAnswers {
  std::array<CheckedQuestion, 4> questions{{{{true, true}}, {{false, true}}, {{true, false}}, {{false, false}}}};
  uint64_t wrong = 0;  // rays with a difference in any question, or in the answers that were given
};
/// Asks any hits and nearest hits, together and one by one, and compares these and `given` with brute force, bit by
/// bit.
CheckedAnswers check_answers(const Accelerator& accelerator, std::span<const Ray> rays, const RayAnswers& given,
                             unsigned threads, const Tell& tell);

}  // namespace raygrain::cli
