// Exact searches: the brute-force oracle and the traversal of binary trees, with the counters that the cost model
// needs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raygrain/bvh.h"
#include "raygrain/mesh.h"
#include "raygrain/ray.h"

namespace raygrain {

/// The oracle: every triangle, one intersector. Nearest hit by (t, index). Invalid rays miss.
Hit intersect_reference(const TriangleMesh& mesh, const Ray& ray);
bool occluded_reference(const TriangleMesh& mesh, const Ray& ray);

/// Counts of one or more searches (they add up).
struct TraceCounters {
  uint64_t inner_hits = 0;      // inner boxes that the ray meets
  uint64_t leaf_hits = 0;       // leaf boxes that the ray meets
  uint64_t leaf_triangles = 0;  // triangles in those leaves
  uint64_t box_tests = 0;       // boxes tested, met or not
  uint64_t triangle_tests = 0;  // calls of the intersector

  friend constexpr bool operator==(const TraceCounters&, const TraceCounters&) = default;
  void add(const TraceCounters& other);
};

/// How a search over a tree goes on from what is known.
struct SearchOptions {
  float skip_before = -kInf;  // boxes that the ray leaves before this t cannot matter
  bool prune = true;          // false: visit everything that the ray meets (the paper's "real cost")
};

/// Nearest hit over the triangles of a tree, merged with `known` by (t, index). `bvh.prims` are triangle ids of `mesh`.
/// Iterative; the tree must be no deeper than kMaxTreeLevels. Invalid rays return `known`.
Hit intersect(const Bvh& bvh, const TriangleMesh& mesh, const Ray& ray, Hit known = {},
              const SearchOptions& options = {}, TraceCounters* counters = nullptr);

/// Is there any hit in [tmin, tmax]?
bool occluded(const Bvh& bvh, const TriangleMesh& mesh, const Ray& ray, const SearchOptions& options = {},
              TraceCounters* counters = nullptr);

/// The same rays, each ended (tmax) at its nearest hit: sample rays for measures that know that rays stop.
std::vector<Ray> end_at_hits(std::span<const Ray> rays, const Bvh& bvh, const TriangleMesh& mesh);

}  // namespace raygrain
