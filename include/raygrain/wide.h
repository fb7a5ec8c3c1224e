// Wide trees: the traversal form of a Bvh, eight children a node, searched with vector instructions chosen at run time.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "raygrain/bvh.h"
#include "raygrain/measure.h"
#include "raygrain/mesh.h"
#include "raygrain/ray.h"
#include "raygrain/trace.h"

namespace raygrain {

/// Instruction sets that kernels are compiled for.
enum class Isa : uint8_t { kScalar, kSse4, kAvx2, kAvx512, kNeon };

/// "scalar", "sse4", "avx2", "avx512", "neon".
const char* name(Isa isa);

/// What this CPU can run, worst first; always holds kScalar.
std::vector<Isa> supported_isas();

/// The one that the environment variable RAYGRAIN_ISA names, or the best of this CPU. Throws Error (kUsage) when
/// RAYGRAIN_ISA names one that is unknown or that this CPU lacks.
Isa default_isa();

/// What a ray pays for each part of a wide tree that it meets, in visits of a node.
struct WideCosts {
  float node = 1;
  float leaf = 1;
  float triangle = 0.05f;  // for each triangle of a leaf
};

struct WideOptions {
  RayMeasure measure = {};  // decides which children are pulled up, which leaves merge, and the order for any hit
  WideCosts costs = {};
  std::optional<Isa> isa = std::nullopt;  // default_isa() without one
  uint32_t max_leaf_size = 8;  // triangles per leaf, 1 ... 8: leaves of the binary tree are merged where that pays
  unsigned threads = 0;        // that plan and write it, asking `measure`; 0: all. They decide no bit of the tree
};

/// An immutable wide tree over the triangles of a mesh. Cheap to copy (shared inside), safe to use from many threads.
/// Answers equal the oracle's, bit for bit, on every instruction set: boxes are padded by their proven rounding error,
/// a float filter drops sure misses, and intersect_triangle decides the rest.
class WideBvh {
 public:
  WideBvh();  // empty: every ray misses

  /// Collapses `tree`, whose prims are triangle ids of `mesh`; neither is kept. The same tree gives the same bytes.
  /// Throws Error: kUsage for options out of range, an instruction set that this CPU lacks, or an id that the mesh does
  /// not have; kBadHeuristic for a measure that is negative or not finite; kLimit beyond 2^43 bytes.
  WideBvh(const Bvh& tree, const TriangleMesh& mesh, const WideOptions& options = {});

  /// Nearest hit by (t, id), merged with `known`. SearchOptions::prune = false visits everything that the ray meets.
  /// Invalid rays return `known`.
  Hit intersect(const Ray& ray, Hit known = {}, const SearchOptions& options = {}) const;

  /// Is there any hit in [tmin, tmax]?
  bool occluded(const Ray& ray, const SearchOptions& options = {}) const;

  /// Many rays, in the given order; `hits` and `flags` (1 = occluded) have the size of `rays`, or Error (kUsage).
  /// 0 threads = all.
  void intersect(std::span<const Ray> rays, std::span<Hit> hits, unsigned threads = 1) const;
  void occluded(std::span<const Ray> rays, std::span<uint8_t> flags, unsigned threads = 1) const;

  /// The same answers with counts of what was done (slower): wide nodes and leaves visited, boxes of children tested,
  /// and calls of intersect_triangle.
  Hit intersect_counted(const Ray& ray, TraceCounters& counters, Hit known = {},
                        const SearchOptions& options = {}) const;
  bool occluded_counted(const Ray& ray, TraceCounters& counters, const SearchOptions& options = {}) const;

  Isa isa() const;
  size_t node_count() const;
  size_t leaf_count() const;
  size_t memory_bytes() const;  // nodes and leaves

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

}  // namespace raygrain
