// Time of a build, split into parts that do not overlap; free when nobody asks.
#pragma once

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

}  // namespace raygrain::builder
