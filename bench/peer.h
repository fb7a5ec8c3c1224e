// Embree 3 behind the benchmark's own types; without it nothing is there (no_peer.cpp).
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "raygrain/mesh.h"

#include "race.h"

namespace raygrain::bench {

enum class PeerQuality { kLow, kMedium, kHigh };
const char* name(PeerQuality quality);

/// Rays in one call of Embree's interface for streams (rtcIntersect1M).
inline constexpr unsigned kStream = 256;

/// How rays are handed to Embree.
struct PeerMode {
  PeerQuality quality = PeerQuality::kMedium;
  bool robust = false, coherent = false;
  unsigned packet = 1;  // 1, 8, 16 or kStream rays a call

  std::string name() const;
};

struct PeerBuild {
  double seconds = 0;
  size_t bytes = 0;  // of the finished scene
};

/// Builds once and forgets the scene.
PeerBuild build_peer(const TriangleMesh& mesh, PeerQuality quality, unsigned threads);

/// A mesh in Embree's hands: MEDIUM and HIGH quality, robust on and off.
class Peer {
 public:
  static bool is_there();

  explicit Peer(const TriangleMesh& mesh);
  ~Peer();
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// Every mode: both qualities, robust on and off, single rays, packets and streams, coherent and incoherent. Empty
  /// where there is no Embree.
  static std::vector<PeerMode> modes();

  void trace(const PeerMode& mode, bool any, const Part& part, unsigned threads) const;

  /// Those to race, ranked on kRaysToRank rays from all over the set: the two fastest of all and the two fastest for
  /// single rays.
  std::vector<PeerMode> best_modes(const BenchRays& set, unsigned threads) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace raygrain::bench
