// Races over whole sets of rays: batches are measured in the size in which they come.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "race.h"

namespace raygrain::bench {

struct Contestant {
  std::function<void(Answers&)> trace;
  std::unique_ptr<Answers> answers;
  double seconds = std::numeric_limits<double>::infinity();  // the least of all rounds
};

/// All take turns. Each goes twice and the second time counts: nobody pays for what another left in the caches. One
/// thread is timed by its processor, several by the clock.
void race_whole(std::vector<Contestant>& contestants, int rounds, unsigned threads);

}  // namespace raygrain::bench
