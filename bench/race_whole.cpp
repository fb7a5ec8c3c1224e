#include "race_whole.h"

#include <algorithm>

#include "stopwatch.h"

namespace raygrain::bench {

void race_whole(std::vector<Contestant>& contestants, int rounds, unsigned threads) {
  for (int round = 0; round < rounds; ++round)
    for (Contestant& c : contestants) {
      if (round >= c.rounds) continue;
      c.trace(*c.answers);
      const Stopwatch watch(threads);
      c.trace(*c.answers);
      c.seconds = std::min(c.seconds, watch.seconds());
    }
}

}  // namespace raygrain::bench
