// Embree 3 behind the benchmark's own types.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "raygrain/mesh.h"
#include "raygrain/ray.h"

namespace raygrain::bench {

/// How rays are handed to Embree.
struct EmbreeMode {
  bool high = false, robust = false, coherent = false;
  unsigned packet = 1;  // 1, 8 or 16 rays a call

  std::string name() const;
};

/// Every mode: both qualities, robust on and off, single rays and packets, coherent and incoherent.
std::vector<EmbreeMode> embree_modes();

/// One built scene.
class EmbreeScene {
 public:
  /// Builds on `threads` threads (0 = all).
  EmbreeScene(const TriangleMesh& mesh, bool high, bool robust, unsigned threads);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  double build_seconds() const;
  size_t memory_bytes() const;

  void intersect(const EmbreeMode& mode, std::span<const Ray> rays, std::span<Hit> hits, unsigned threads) const;
  void occluded(const EmbreeMode& mode, std::span<const Ray> rays, std::span<uint8_t> flags, unsigned threads) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace raygrain::bench
