// Which structure answers which rays: decided once, by the work that sample rays cost. Work is counted, not timed, so
// equal builds take equal routes. No answer depends on them.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "raygrain/coverage.h"

#include "accel/asked_coverages.h"
#include "accel/batch_coverages.h"
#include "accel/foreign.h"

namespace raygrain {

/// Of one kind of question.
struct Route {
  AskedCoverages asked;           // about rays one by one; nothing of invalid rays
  BatchCoverages batches;         // about many rays with something in common
  std::vector<uint8_t> covers;    // by area: its coverage is among these
  std::vector<uint8_t> searches;  // by area: its local tree is searched
  bool searches_some = false;
  ForeignFilter foreign;  // rays that none of these concerns
};

/// Any hit or the nearest one, of one ray, and of arrays, whose rays the global tree answers several at a time.
struct Routes {
  Route any, nearest, any_of_many, nearest_of_many;
};

/// What sample rays are expected to cost each way, in nanoseconds of the machine on which the prices were found: the
/// rays along an area, which its coverage may answer, and rays within its tolerance. Infinite where there is no way.
/// Where no rays along the area were found (`has_samples`), nothing says that coverage pays, and it is not asked.
struct WayCosts {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double coverage = kNone, local = kNone, global = 0;
  double off_local = kNone, off_global = 0;
  bool has_samples = true;
};
struct AreaCosts {
  WayCosts any, nearest;
};

/// What shares of the global tree's costs a ray of an array has.
struct ManyShares {
  double any = 1, nearest = 1;
};

/// A ray of a large batch costs its coverage this share of what it costs alone, or less. Measured:
/// docs/performance-rays.md, "How many rays a call".
inline constexpr double kShareOfBatch = 0.4;

/// The cheapest ways. Without costs every structure that is there is used.
Routes choose_routes(std::span<const AreaGeometry> areas, std::span<const Coverage> coverages, bool has_locals,
                     std::span<const AreaCosts> costs, ManyShares many);

}  // namespace raygrain
