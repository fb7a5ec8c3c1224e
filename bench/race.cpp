#include "race.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "base/timer.h"

namespace raygrain::bench {

std::vector<double> race(const std::vector<Contender>& contenders, size_t rays, unsigned threads, int rounds) {
  const size_t part = size_t{4096} * threads;
  const size_t parts = (rays + part - 1) / part;
  std::vector<std::vector<double>> least(contenders.size(),
                                         std::vector<double>(parts, std::numeric_limits<double>::infinity()));
  for (int round = 0; round < rounds; ++round)
    for (size_t p = 0; p < parts; ++p)
      for (size_t i = 0; i < contenders.size(); ++i) {
        const size_t before = (p + parts - 1) % parts;
        contenders[i](before * part, std::min(rays, (before + 1) * part));  // its own tree into the caches
        const Timer timer;
        contenders[i](p * part, std::min(rays, (p + 1) * part));
        least[i][p] = std::min(least[i][p], timer.seconds());
      }
  std::vector<double> seconds;
  for (const std::vector<double>& times : least) seconds.push_back(std::accumulate(times.begin(), times.end(), 0.0));
  return seconds;
}

BenchRays spread_sample(const BenchRays& set, size_t count) {
  if (set.rays.size() <= count) return set;
  const size_t blocks = (count + kRaysPerTask - 1) / kRaysPerTask;
  BenchRays sample{set.name, set.any, {}};
  for (size_t i = 0; i < blocks; ++i) {
    const size_t begin = (set.rays.size() - kRaysPerTask) * i / std::max<size_t>(1, blocks - 1);
    for (size_t k = begin; k < begin + kRaysPerTask; ++k) sample.rays.push_back(set.rays[k]);
  }
  return sample;
}

double try_out(const Tracer& tracer, const BenchRays& set, unsigned threads) {
  Answers answers(set.rays.size());
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 2; ++round) {
    const Timer timer;
    tracer(set.any, Part(set, answers, 0, set.rays.size()), threads);
    least = std::min(least, timer.seconds());
  }
  return least;
}

}  // namespace raygrain::bench
