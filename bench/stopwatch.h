// Seconds of work on so many threads.
#pragma once

#include <time.h>

#include "base/timer.h"

namespace raygrain::bench {

/// One thread is timed by its processor, for other programs interrupt it without counting; several by the clock.
class Stopwatch {
 public:
  explicit Stopwatch(unsigned threads) : is_alone_(threads == 1), processor_(processor_seconds()) {}

  double seconds() const { return is_alone_ ? processor_seconds() - processor_ : clock_.seconds(); }

 private:
  /// Of this thread.
  static double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }

  bool is_alone_;
  double processor_;
  Timer clock_;
};

}  // namespace raygrain::bench
