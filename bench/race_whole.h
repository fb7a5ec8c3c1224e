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
  int rounds = std::numeric_limits<int>::max();              // it takes part in at most so many
  double seconds = std::numeric_limits<double>::infinity();  // the least of all rounds
};

/// All take turns. Each goes twice and the second time counts: nobody pays for what another left in the caches.
void race_whole(std::vector<Contestant>& contestants, int rounds, unsigned threads);

}  // namespace raygrain::bench
