// Time of a build, split into parts that do not overlap; free when nobody asks.
#pragma once

#include <span>

#include "raygrain/build.h"

#include "base/timer.h"

namespace raygrain::builder {

/// Each lap charges the time since the last one to a part.
class Laps {
 public:
  explicit Laps(BuildTimes* times) : times_(times) {}

  void lap(double BuildTimes::*part) {
    if (!times_) return;
    const double now = timer_.seconds();
    times_->*part += now - last_;
    last_ = now;
  }
  /// Charges it to nothing.
  void skip() {
    if (times_) last_ = timer_.seconds();
  }
  void finish() {
    if (times_) times_->total = timer_.seconds();
  }

 private:
  BuildTimes* times_;
  Timer timer_;
  double last_ = 0;
};

/// All but the total.
inline constexpr double BuildTimes::*kTimedParts[] = {&BuildTimes::orientations, &BuildTimes::candidates,
                                                      &BuildTimes::partition, &BuildTimes::stop, &BuildTimes::nodes};

/// Charges the parts of what was done side by side to the wall-clock time that it took together.
template <class Piece>
void add_scaled(BuildTimes& times, std::span<const Piece> pieces, double seconds) {
  BuildTimes sum;
  for (const auto& piece : pieces) {
    sum.total += piece.times.total;
    for (const auto part : kTimedParts) sum.*part += piece.times.*part;
  }
  if (!(sum.total > 0)) return;
  for (const auto part : kTimedParts) times.*part += sum.*part * (seconds / sum.total);
}

}  // namespace raygrain::builder
