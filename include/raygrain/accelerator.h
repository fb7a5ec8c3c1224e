// The facade: mesh + influence areas in, exact answers for every ray out.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "raygrain/area.h"
#include "raygrain/bvh.h"
#include "raygrain/coverage.h"
#include "raygrain/frame_tree.h"
#include "raygrain/mesh.h"
#include "raygrain/registry.h"
#include "raygrain/top_level.h"
#include "raygrain/trace.h"
#include "raygrain/wide.h"

namespace raygrain {

/// Which triangles belong to an area's local tree. Must hold every triangle that overlaps the region, or answers may be
/// wrong: a rule for experiments, not for use.
using MembershipRule = std::function<bool(const AreaGeometry&, Vec3 a, Vec3 b, Vec3 c)>;

/// Sample rays for recipes whose measure needs them (SAMPLED, VISIBLE), of an area or, for a null area, of the global
/// tree; they need not know their hits. May be called from several threads.
using SampleSource = std::function<std::vector<Ray>(const InfluenceArea* area)>;

/// The form of the trees that rays are sent through. Answers are the same.
enum class Traversal {
  kWide,    // WideBvh: fast
  kBinary,  // Bvh: what builders return and costs are defined on; for studies
};

/// The space that local trees are built in. Answers are the same.
enum class LocalSpace {
  kWorld,  // the world's axes, as in the paper
  kRay,    // the area's ray space, besides: rays that a frame serves take the tree there
  kNone,   // no local trees: coverage answers rays along an area, the global tree all others
};

/// Who answers a ray for which an area has structures of its own. Answers are the same.
enum class Routing {
  kCheapest,  // of coverage, local tree and global tree the one that sample rays of the area cost least, predicted
  kAreas,     // the area's structures, whatever they cost
};

struct AcceleratorOptions {
  Recipe local{"PAH", "ALL", "binned", {}};         // of each area's tree
  Recipe global{"SAH", "ALL", "binned", {}, true};  // of the tree that answers all other rays
  std::optional<Quality> quality;                   // of the global tree: replaces its recipe's builder
  bool reinsert = false;                            // improve the global tree by reinsertion, under its own measure
  bool reinsert_local = false;                      // ... and each area's tree, likewise
  /// Name of the measure that the wide forms of the areas' trees are made by: which nodes become children of one node,
  /// and in which order any hit asks them. Empty: the local recipe's.
  std::string wide_measure = {};
  Traversal traversal = Traversal::kWide;
  std::optional<LocalSpace> space = std::nullopt;  // nothing: see local_space
  Routing routing = Routing::kCheapest;            // under Traversal::kBinary always kAreas
  RayDensity density = RayDensity::kNearPlane;     // of point areas' rays, for their trees under LocalSpace::kRay
  std::optional<FrameKind> frame;  // of areas that it suits; the others, and without one: the cheapest by prediction
  std::optional<Isa> isa;          // of wide trees; default_isa() without one
  /// Of each area, over all triangles that its rays can meet: answers batches of rays that share its direction or its
  /// point. Nothing, and under Traversal::kBinary: none is built.
  std::optional<CoverageOptions> coverage = CoverageOptions{};
  TopLevelOptions top_level;
  Registry registry = default_registry();
  MembershipRule membership;  // empty: overlaps(region, a, b, c)
  SampleSource samples;       // empty: none; an area's also decide about its routes
  unsigned threads = 0;       // of the build; 0 = all; nothing depends on it
  /// Called now and then, never by two threads at once, with the finished share of the build in [0, 1], not descending.
  /// false cancels: Error kCancelled.
  std::function<bool(double done)> progress;
};

/// The space of areas' trees that an accelerator with these options builds: the given one. Without one kNone where
/// coverage and the global tree answer, since a tree in the world hardly ever costs less than both
/// (docs/performance-rays.md, "Which structure pays"); kWorld where such trees are asked for: without coverage, under
/// Traversal::kBinary or Routing::kAreas, or where `local`, `reinsert_local`, `wide_measure` or `membership` is set.
LocalSpace local_space(const AcceleratorOptions& options);

/// One area with its tree; `predicted_cost` is the estimated cost per ray under the tree's own measure.
struct LocalTree {
  InfluenceArea area;
  std::shared_ptr<const Bvh> tree;
  BuildLog log;
  double predicted_cost = 0;
  RayMeasure measure = {};  // the tree's own, or AcceleratorOptions::wide_measure; decides how its wide form is made
  std::optional<FrameTree> in_ray_space = std::nullopt;  // LocalSpace::kRay, where some ray is sent there
  double build_seconds = 0;  // of an accelerator's: with the wide form, ray space, and an equal part of the corners
};

/// Who answered the rays of an area: those that its coverage or its tree answered, and those that are the area's and
/// still went to the global tree. A valid ray is the area's if AreaGeometry::serves it, or if its line is within a
/// millionth (sine) of the area's direction, or of a line through its point, inside the area's window, whichever way it
/// goes. A ray that the global tree answers may be several areas', any other ray is counted once.
struct AreaUse {
  uint64_t covered = 0;  // answered by the area's coverage
  uint64_t local = 0;    // the search ended in the area's tree
  uint64_t global = 0;   // the area's, but answered by the global tree

  uint64_t answered() const { return covered + local; }
  friend bool operator==(const AreaUse&, const AreaUse&) = default;
};

/// What happened while rays were traced (sums): the same for any number of threads, and on the ways that rays take
/// without counters. Under Traversal::kWide the nodes and boxes of `local` and `global` are those of the wide trees
/// (see WideBvh::intersect_counted): the global tree counts them ray by ray, where otherwise it answers several at
/// once. Calls at the same time need counters of their own.
struct AcceleratorCounters {
  uint64_t rays = 0;
  uint64_t invalid_rays = 0;     // misses by definition
  uint64_t covered = 0;          // answered by an area's coverage; nothing below is counted for them
  uint64_t areas_tested = 0;     // candidates from the top level that were asked whether they serve the ray
  uint64_t areas_serving = 0;    // ... and do
  uint64_t local_searches = 0;   // local trees searched
  uint64_t local_hits = 0;       // rays that ended with an accepted local hit
  uint64_t continued = 0;        // rays that left one area and entered the next
  uint64_t columns = 0;          // of the local searches: in ray space, as columns
  uint64_t cones = 0;            // ... as cones
  uint64_t global_searches = 0;  // rays that needed the global tree
  TraceCounters local, global;   // work in local trees and in the global tree
  std::vector<AreaUse> areas;    // one for each area, once a ray was counted

  friend bool operator==(const AcceleratorCounters&, const AcceleratorCounters&) = default;
  void add(const AcceleratorCounters& other);
};

/// How an area is asked: any hits or nearest hits, in one call for all rays or in one call for each.
struct AreaQuestion {
  bool any = true, together = true;

  friend bool operator==(const AreaQuestion&, const AreaQuestion&) = default;
};
/// "any hits together", "closest hits together", "any hits one by one" or "closest hits one by one".
std::string_view name(AreaQuestion question);

/// Rays after which a build has paid for itself, in [0, infinity]: infinity where a ray saves nothing, and where a time
/// is not a number.
double break_even_rays(double build_seconds, double area_nanoseconds, double global_nanoseconds);

/// How an area's rays fare, asked one way. Times are measured on one thread, the least of three.
struct AreaTimes {
  AreaQuestion question;
  size_t rays = 0;                // timed
  AreaUse use;                    // of them: who answered
  double area_nanoseconds = 0;    // a ray through this accelerator
  double global_nanoseconds = 0;  // a ray through its global tree alone, asked likewise
  double break_even_rays = 0;     // of such rays alone, for all that the area has; infinity where nothing of it answers
};

/// What an area costs and saves.
struct AreaReport {
  std::string name;
  size_t triangles = 0;  // of the local tree; some may be there more than once
  /// Of everything that the area has, and an equal part of what areas share (neighbours and corners of triangles, the
  /// top level, sampling rays to choose routes): by the clock, on the threads and beside what was built meanwhile.
  double build_seconds = 0;
  size_t memory_bytes = 0;  // of everything that the area has, without what areas share
  std::string structures;   // e.g. "coverage, tree in ray space (shear_y), tree"
  std::string routes;       // who answers which rays, and at what predicted cost
  /// By question, in the order of their names above; none where the area has no structures, and without questions that
  /// it has no rays for. Any hits go from surfaces in the region to the light or point; closest hits start where the
  /// area's rays do: on the face (plane area), at the point (point area).
  std::vector<AreaTimes> times;
  AreaUse use;       // of the counted rays
  double share = 0;  // in [0, 1]: of all counted rays, those that the area's structures answered
};

struct Explanation {
  std::vector<AreaReport> areas;
  size_t global_bytes = 0;       // of the global tree
  size_t shared_bytes = 0;       // of what areas share: these, global_bytes and the areas' bytes are all that there is
  AcceleratorCounters counters;  // as handed in
};

/// Which of the questions could not be timed, and why, for people; empty where all were, or none was asked.
std::string_view missing_times(const AreaReport& area);

/// Lines for people: of each area first what pays, soonest first.
std::string to_text(const Explanation& explanation);

/// Immutable, cheap to copy (shared inside), safe to use from many threads. Without areas every ray goes to the global
/// tree.
///
/// A ray along an area that its coverage can answer is answered there. Another is answered by the local tree of the
/// area that serves it at the lowest predicted cost. Under Routing::kCheapest both only where sample rays were cheaper
/// that way than through the global tree, which answers all others at once: local trees that no ray is sent to keep
/// their binary form alone. A local hit counts only at or before the exit from that area's
/// region; otherwise the search goes on in the next area that holds the exit point and serves the ray there, at last in
/// the global tree. Results equal the brute-force oracle's, bit for bit. Rays with tmin < 0 go straight to the global
/// tree; invalid rays are misses and are counted.
class Accelerator {
 public:
  /// Throws Error: kBadMesh, kBadArea (naming the area), kUsage (unknown recipe, option out of range), kBadHeuristic.
  explicit Accelerator(TriangleMesh mesh, std::vector<InfluenceArea> areas = {},
                       const AcceleratorOptions& options = {});

  /// From finished parts. Throws Error: kBadMesh, kBadArea, kUsage (a part is missing, or a tree does not fit the
  /// mesh).
  Accelerator(std::shared_ptr<const TriangleMesh> mesh, std::vector<LocalTree> locals,
              std::shared_ptr<const Bvh> global, const TopLevelOptions& top_level = {},
              Traversal traversal = Traversal::kWide);

  /// Other local trees over the same mesh and global tree, which are shared with this one. Same errors.
  Accelerator with_local_trees(std::vector<LocalTree> locals, const TopLevelOptions& top_level = {}) const;

  /// Nearest hit by (t, triangle id). Counting costs time: leave `counters` out where they are not read.
  Hit intersect(const Ray& ray, AcceleratorCounters* counters = nullptr) const;
  /// Is there any hit in [tmin, tmax]?
  bool occluded(const Ray& ray, AcceleratorCounters* counters = nullptr) const;

  /// Many rays of any kind, answered as one by one; those that a call below could have are answered as fast as there,
  /// or nearly, where there are enough of them; `hits` and `flags` (1 = occluded) have the size of `rays`, or Error
  /// (kUsage). 0 threads = all.
  void intersect(std::span<const Ray> rays, std::span<Hit> hits, unsigned threads = 1,
                 AcceleratorCounters* counters = nullptr) const;
  void occluded(std::span<const Ray> rays, std::span<uint8_t> flags, unsigned threads = 1,
                AcceleratorCounters* counters = nullptr) const;

  /// Rays that share a direction or a point, tmin 0: what most users have, and several times faster than rays of any
  /// kind where an area has that direction or point. In any order; answers as of the single rays. Sizes must agree, or
  /// Error (kUsage). 0 threads = all.
  ///
  /// From each origin along `direction`, tmax infinite.
  void occluded(std::span<const Vec3> origins, Vec3 direction, std::span<uint8_t> flags, unsigned threads = 0,
                AcceleratorCounters* counters = nullptr) const;
  void intersect(std::span<const Vec3> origins, Vec3 direction, std::span<Hit> hits, unsigned threads = 0,
                 AcceleratorCounters* counters = nullptr) const;
  /// From each origin to `point`: direction float32(point - origin), tmax 1.
  void occluded_towards(std::span<const Vec3> origins, Vec3 point, std::span<uint8_t> flags, unsigned threads = 0,
                        AcceleratorCounters* counters = nullptr) const;
  /// From `eye` along each direction, tmax infinite.
  void intersect_from(Vec3 eye, std::span<const Vec3> directions, std::span<Hit> hits, unsigned threads = 0,
                      AcceleratorCounters* counters = nullptr) const;

  /// One per area, or none.
  std::span<const Coverage> coverages() const;

  /// Says which areas there are, what each costs and saves, after how many rays its build has paid, and where rays
  /// went: pass the counters of your last batch. Casts up to `rays` rays (> 0) for each area and question, seeded; only
  /// times differ from call to call. Throws Error (kUsage): 0 rays, or counters of other areas.
  Explanation explain(const AcceleratorCounters& counters = {}, size_t rays = 4096) const;

  const TriangleMesh& mesh() const;
  std::span<const LocalTree> local_trees() const;
  const Bvh& global_tree() const;
  const TopLevel& top_level() const;
  Traversal traversal() const;
  /// Everything but the mesh and what measures hold (VISIBLE: 7 MB each), each thing once: trees in all forms with
  /// their logs, corners of triangles, coverages, top level, tables of areas.
  size_t memory_bytes() const;
  /// The wide trees of these alone, with the corners of those in ray space; 0 under Traversal::kBinary.
  size_t wide_memory_bytes() const;

 private:
  struct Parts;
  explicit Accelerator(std::shared_ptr<const Parts> parts);
  std::shared_ptr<const Parts> parts_;
};

/// The triangles of a mesh that belong to an area, ascending. An empty rule means overlap with the region.
std::vector<uint32_t> area_members(const TriangleMesh& mesh, const AreaGeometry& geometry,
                                   const MembershipRule& rule = {});

/// The sample rays that a recipe is made from: as given, but for a measure that is about first hits (VISIBLE) each
/// ended at its own, among all triangles. `tree` is any tree over them; without one a quick one is built. Rays of which
/// some end already are left as they are.
std::vector<Ray> samples_for(const Recipe& recipe, const Registry& registry, std::span<const Ray> samples,
                             const TriangleMesh& mesh, const Bvh* tree = nullptr, unsigned threads = 0);

/// Builds one area's local tree over the triangles that overlap its region; `prims` are triangle ids of `mesh`. The
/// samples go through samples_for, unless `run` says that they have.
LocalTree build_local_tree(const TriangleMesh& mesh, const InfluenceArea& area, const Recipe& recipe,
                           const Registry& registry, const MembershipRule& membership = {},
                           std::span<const Ray> samples = {}, const BuildRun& run = {});

/// Builds the recipe's tree over all triangles. The samples likewise.
Bvh build_global_tree(const TriangleMesh& mesh, const Recipe& recipe, const Registry& registry, BuildLog* log = nullptr,
                      std::span<const Ray> samples = {}, const BuildRun& run = {});

}  // namespace raygrain
