#include "race_whole.h"

#include <algorithm>

#include <time.h>

#include "base/timer.h"

namespace raygrain::bench {
namespace {

/// Of this thread's processor, for what runs on it alone: other programs interrupt it without counting.
double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

void race_whole(std::vector<Contestant>& contestants, int rounds, unsigned threads) {
  for (int round = 0; round < rounds; ++round)
    for (Contestant& c : contestants) {
      c.trace(*c.answers);
      const Timer timer;
      const double before = processor_seconds();
      c.trace(*c.answers);
      c.seconds = std::min(c.seconds, threads == 1 ? processor_seconds() - before : timer.seconds());
    }
}

}  // namespace raygrain::bench
