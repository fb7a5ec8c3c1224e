// The facade: mesh + influence areas in, exact answers for every ray out.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "raygrain/area.h"
#include "raygrain/bvh.h"
#include "raygrain/mesh.h"
#include "raygrain/registry.h"
#include "raygrain/top_level.h"
#include "raygrain/trace.h"

namespace raygrain {

/// Which triangles belong to an area's local tree. Must hold every triangle that overlaps the region, or answers may be
/// wrong: a rule for experiments, not for use.
using MembershipRule = std::function<bool(const AreaGeometry&, Vec3 a, Vec3 b, Vec3 c)>;

/// Sample rays for recipes whose measure needs them (SAMPLED), of an area or, for a null area, of the global tree. May
/// be called from several threads.
using SampleSource = std::function<std::vector<Ray>(const InfluenceArea* area)>;

struct AcceleratorOptions {
  Recipe local{"PAH", "ALL", "binned", {}};   // of each area's tree
  Recipe global{"SAH", "ALL", "binned", {}};  // of the tree that answers all other rays
  std::optional<Quality> quality;             // of the global tree: replaces its recipe's builder
  bool reinsert = false;                      // improve the global tree by reinsertion, under its own measure
  TopLevelOptions top_level;
  Registry registry = default_registry();
  MembershipRule membership;  // empty: overlaps(region, a, b, c)
  SampleSource samples;       // empty: none
  unsigned threads = 0;       // of the build; 0 = all
};

/// One area with its tree; `predicted_cost` is the estimated cost per ray under the tree's own measure.
struct LocalTree {
  InfluenceArea area;
  std::shared_ptr<const Bvh> tree;
  BuildLog log;
  double predicted_cost = 0;
};

/// What happened while rays were traced (sums).
struct AcceleratorCounters {
  uint64_t rays = 0;
  uint64_t invalid_rays = 0;     // misses by definition
  uint64_t areas_tested = 0;     // candidates from the top level that were asked whether they serve the ray
  uint64_t areas_serving = 0;    // ... and do
  uint64_t local_searches = 0;   // local trees searched
  uint64_t local_hits = 0;       // rays that ended with an accepted local hit
  uint64_t continued = 0;        // rays that left one area and entered the next
  uint64_t global_searches = 0;  // rays that needed the global tree
  TraceCounters local, global;   // work in local trees and in the global tree

  friend bool operator==(const AcceleratorCounters&, const AcceleratorCounters&) = default;
  void add(const AcceleratorCounters& other);
};

/// Immutable, cheap to copy (shared inside), safe to use from many threads. Without areas every ray goes to the global
/// tree.
///
/// A ray is answered by the local tree of the area that serves it at the lowest predicted cost. A local hit counts only
/// at or before the exit from that area's region; otherwise the search goes on in the next area that holds the exit
/// point and serves the ray there, at last in the global tree. Results equal the brute-force oracle's, bit for bit.
/// Rays with tmin < 0 go straight to the global tree; invalid rays are misses and are counted.
class Accelerator {
 public:
  /// Throws Error: kBadMesh, kBadArea (naming the area), kUsage (unknown recipe, option out of range), kBadHeuristic.
  explicit Accelerator(TriangleMesh mesh, std::vector<InfluenceArea> areas = {},
                       const AcceleratorOptions& options = {});

  /// From finished parts, e.g. to share one mesh and global tree between several sets of local trees. Throws Error:
  /// kBadMesh, kBadArea, kUsage (a part is missing, or a tree does not fit the mesh).
  Accelerator(std::shared_ptr<const TriangleMesh> mesh, std::vector<LocalTree> locals,
              std::shared_ptr<const Bvh> global, const TopLevelOptions& top_level = {});

  Hit intersect(const Ray& ray, AcceleratorCounters* counters = nullptr) const;
  bool occluded(const Ray& ray, AcceleratorCounters* counters = nullptr) const;

  const TriangleMesh& mesh() const;
  std::span<const LocalTree> local_trees() const;
  const Bvh& global_tree() const;
  const TopLevel& top_level() const;
  size_t memory_bytes() const;  // trees, top level and areas, without the mesh

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

/// The triangles of a mesh that belong to an area, ascending. An empty rule means overlap with the region.
std::vector<uint32_t> area_members(const TriangleMesh& mesh, const AreaGeometry& geometry,
                                   const MembershipRule& rule = {});

/// Builds one area's local tree over the triangles that overlap its region; `prims` are triangle ids of `mesh`.
LocalTree build_local_tree(const TriangleMesh& mesh, const InfluenceArea& area, const Recipe& recipe,
                           const Registry& registry, const MembershipRule& membership = {},
                           std::span<const Ray> samples = {});

/// Builds the recipe's tree over all triangles.
Bvh build_global_tree(const TriangleMesh& mesh, const Recipe& recipe, const Registry& registry, BuildLog* log = nullptr,
                      std::span<const Ray> samples = {});

}  // namespace raygrain
