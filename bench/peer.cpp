#include "peer.h"

#include <algorithm>

namespace raygrain::bench {

const char* name(PeerQuality quality) {
  return quality == PeerQuality::kLow ? "low" : (quality == PeerQuality::kMedium ? "medium" : "high");
}

std::string PeerMode::name() const {
  return std::string(bench::name(quality)) + (robust ? " robust " : " ") +
         (packet == kStream ? "stream" : std::to_string(packet)) + (coherent ? " coherent" : " incoherent");
}

std::vector<PeerMode> Peer::best_modes(const BenchRays& set, unsigned threads) const {
  const BenchRays sample = spread_sample(set, kRaysToRank);
  std::vector<std::pair<double, PeerMode>> ranking;
  for (const PeerMode& mode : modes()) {
    const auto tracer = [&](bool any, const Part& part, unsigned n) { trace(mode, any, part, n); };
    ranking.emplace_back(try_out(tracer, sample, threads), mode);
  }
  std::ranges::stable_sort(ranking, {}, &std::pair<double, PeerMode>::first);
  std::vector<PeerMode> best;
  size_t singles = 0;
  for (size_t i = 0; i < ranking.size(); ++i) {
    const bool is_single = ranking[i].second.packet == 1;
    if (i < 2 || (is_single && singles < 2)) best.push_back(ranking[i].second);
    singles += is_single;
  }
  return best;
}

}  // namespace raygrain::bench
