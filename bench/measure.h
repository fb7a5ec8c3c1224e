// Rows of a result table: raygrain's interfaces raced against Embree's best modes on one set of rays.
#pragma once

#include <string>
#include <vector>

#include "peer.h"
#include "race.h"
#include "suite.h"

namespace raygrain::bench {

/// A way to use raygrain.
struct Entrant {
  std::string api;   // one row each
  std::string tree;  // of entrants with the same api the fastest is shown
  Tracer trace;
};

/// Races the entrants (of each api the two fastest on kRaysToRank rays from all over the set) and the peer's best
/// modes, at least seven rounds, and reports a row for each api. `row` holds suite and scene. Entrants of one set must
/// agree bit for bit, or std::logic_error.
void measure(const Row& row, const TriangleMesh& mesh, const BenchRays& set, const std::vector<Entrant>& entrants,
             const Peer& peer, unsigned threads, Results& results);

/// Counts the rays about which two tracers differ, and puts up to ten of them to the oracle.
Differences count_differences(const TriangleMesh& mesh, const BenchRays& set, const Answers& ours,
                              const Answers& theirs);

}  // namespace raygrain::bench
