// Several ways to trace the same rays, timed in turns.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "raygrain/ray.h"

#include "ray_sets.h"

namespace raygrain::bench {

/// Rays per task of a parallel loop.
inline constexpr size_t kRaysPerTask = 1024;

/// Rays on which tracers are ranked.
inline constexpr size_t kRaysToRank = 50000;

/// Room for the answers to a set.
struct Answers {
  std::vector<Hit> hits;
  std::vector<uint8_t> flags;

  explicit Answers(size_t count) : hits(count), flags(count) {}
};

/// The part of a set and of its answers that a contender works on.
struct Part {
  std::span<const Ray> rays;
  std::span<Hit> hits;
  std::span<uint8_t> flags;

  Part(const BenchRays& set, Answers& answers, size_t begin, size_t end)
      : rays(std::span(set.rays).subspan(begin, end - begin)),
        hits(std::span(answers.hits).subspan(begin, end - begin)),
        flags(std::span(answers.flags).subspan(begin, end - begin)) {}
};

/// Answers rays on so many threads: flags for any hit, hits for the closest.
using Tracer = std::function<void(bool any, const Part& part, unsigned threads)>;

/// Seconds of each on the rays begin ... end - 1 of a set of `rays`. All take turns on every part of it, `rounds` times
/// over the whole, and the least time for each part counts: other programs disturb a short part less often than a long
/// one. Before its turn each traces another part untimed: what is in the caches is its own, but not from these rays.
using Contender = std::function<void(size_t begin, size_t end)>;
std::vector<double> race(const std::vector<Contender>& contenders, size_t rays, unsigned threads, int rounds);

/// About `count` rays of a set to rank tracers on: blocks of consecutive rays, spread evenly over the set in its order.
BenchRays spread_sample(const BenchRays& set, size_t count);

/// Seconds for all rays of a set, the least of two.
double try_out(const Tracer& tracer, const BenchRays& set, unsigned threads);

}  // namespace raygrain::bench
