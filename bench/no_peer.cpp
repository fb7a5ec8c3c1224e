// Where Embree is not installed: raygrain runs alone.
#include "peer.h"

namespace raygrain::bench {

struct Peer::State {};

bool Peer::is_there() {
  return false;
}

Peer::Peer(const TriangleMesh&) {}
Peer::~Peer() = default;

std::vector<PeerMode> Peer::modes() {
  return {};
}

void Peer::trace(const PeerMode&, bool, const Part&, unsigned) const {}

PeerBuild build_peer(const TriangleMesh&, PeerQuality, unsigned) {
  return {};
}

}  // namespace raygrain::bench
