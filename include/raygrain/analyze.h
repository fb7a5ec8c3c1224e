// What a tree is worth and what rays really cost: pure functions over finished trees, top levels and ray sets.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "raygrain/accelerator.h"
#include "raygrain/area.h"
#include "raygrain/build.h"
#include "raygrain/bvh.h"
#include "raygrain/fields.h"
#include "raygrain/measure.h"
#include "raygrain/ray.h"
#include "raygrain/top_level.h"
#include "raygrain/trace.h"

namespace raygrain {

/// Levels up to which sibling overlap is summed; the last stands for all.
inline constexpr std::array<uint32_t, 5> kOverlapLevels{4, 7, 10, 15, 100};

/// Shape and predicted worth of a tree under a measure (any, not only the one that built it).
struct TreeStats {
  double estimated_cost = 0;  // mean cost of a ray: sum of p * inner + p * n * triangle, p = min(measure / total, 1)
  size_t nodes = 0, leaves = 0, triangles = 0;
  double triangles_per_leaf = 0;
  size_t max_triangles_per_leaf = 0;
  uint32_t max_level = 0;  // depth in edges
  double mean_leaf_depth = 0;
  double small_child_ratio = 0, large_child_ratio = 0;  // mean over inner nodes of measure(smaller, larger child) / own
  size_t memory_bytes = 0;                              // measured
  size_t paper_memory_bytes = 0;                        // see below
};
TreeStats analyze(const Bvh& bvh, const RayMeasure& measure, const CostModel& costs = {});

/// Memory as section 9.6 of the paper counts it: 40 B per node (a box of 24 B and two pointers), and 4 B per triangle
/// of a leaf.
constexpr size_t paper_memory_bytes(size_t nodes, size_t triangles) {
  return 40 * nodes + 4 * triangles;
}
/// The same for an influence area (184 B for a plane area, 336 B for a point area) ...
constexpr size_t paper_memory_bytes(const InfluenceArea& area) {
  return std::holds_alternative<PlaneArea>(area.shape) ? 184 : 336;
}
/// ... and for an octree: 56 B per node (a box and eight pointers of 4 B), and 4 B per area that a leaf lists.
constexpr size_t paper_octree_bytes(size_t nodes, size_t listed_areas) {
  return 56 * nodes + 4 * listed_areas;
}

/// Sum of area(left hull with right hull) / sum of min(area left, area right) over inner nodes of level <=
/// kOverlapLevels[i]; 0 where the denominator is.
struct OverlapStats {
  std::array<double, kOverlapLevels.size()> plain{}, culled{};
};
OverlapStats analyze_overlap(const Bvh& bvh, const AreaGeometry& area);

/// What the builder noted.
struct BuildStats {
  double orientations_per_node = 0;  // orientations tried / inner nodes
  double fallback_share = 0;         // forced fallbacks / inner nodes
  BuildTimes times;
};
BuildStats analyze_build(const Bvh& bvh, const BuildLog& log);

/// Mean cost of rays through one tree.
struct TraceStats {
  size_t rays = 0, hits = 0;
  double real_cost = 0;    // mean over rays, full traversal: +inner per inner box met, +n * triangle per leaf met
  double pruned_cost = 0;  // the same when the nearest hit so far prunes
  double real_cost_deviation = 0;  // sample standard deviation of the real cost; / sqrt(rays) is the mean's error
  double hit_ratio = 0;            // hits / rays
  double inner_hits = 0, leaf_hits = 0, leaf_triangles = 0;  // means per ray, full traversal
};
TraceStats analyze_rays(const Bvh& bvh, const TriangleMesh& mesh, std::span<const Ray> rays,
                        const CostModel& costs = {}, unsigned threads = 0);

/// Full-traversal cost of one ray from its counters.
constexpr double ray_cost(const TraceCounters& c, const CostModel& costs) {
  return static_cast<double>(costs.inner) * static_cast<double>(c.inner_hits) +
         static_cast<double>(costs.triangle) * static_cast<double>(c.leaf_triangles);
}

/// The hit ratio above which searching a local tree first costs less than the global tree alone:
/// local + (1 - h) * miss = global. `local` is the local tree's mean cost over all rays, `miss` the global tree's mean
/// cost over those without an accepted local hit, `global` its mean over all. Below 0: always; above 1: never; NaN
/// where `miss` is 0, since nothing is lost then.
constexpr double break_even_hit_ratio(double local, double miss, double global) {
  return miss > 0 ? (local + miss - global) / miss : std::numeric_limits<double>::quiet_NaN();
}

/// Rays through a local tree with the global one behind it: what an area is worth. All costs are real costs (full
/// traversal). A local hit is accepted at or before the ray's exit from the area's region.
struct FallbackStats {
  size_t rays = 0, served = 0;
  double local_cost = 0;          // mean in the local tree over the rays that it serves
  double cost_with_fallback = 0;  // mean over all rays: local, plus global for rays without an accepted local hit
  double global_cost = 0;         // mean of the same rays in the global tree alone
  double local_miss_cost = 0;     // mean in the global tree of the rays without an accepted local hit
  double hit_ratio = 0;           // accepted local hits / rays
  double break_even = 0;          // break_even_hit_ratio of these rays
};
FallbackStats analyze_fallback(const LocalTree& local, const Bvh& global, const TriangleMesh& mesh,
                               std::span<const Ray> rays, const CostModel& costs = {}, unsigned threads = 0);

/// The top level: shape, and how sharp its answers are. A list has no nodes, and every region in its one "leaf".
struct TopLevelStats {
  size_t nodes = 0, leaves = 0;
  double areas_per_leaf = 0;
  double false_candidates = 0;  // mean per query point: listed regions that do not contain the point
  size_t memory_bytes = 0;
  size_t paper_memory_bytes = 0;  // paper_octree_bytes; 4 B per region for a list
  double build_seconds = 0;       // 0 where the top level was handed over finished
  double query_seconds = 0;       // mean per query
};
TopLevelStats analyze(const TopLevel& top_level, std::span<const ConvexRegion> regions, std::span<const Vec3> points);
/// Builds the top level, timed, and analyses it.
TopLevelStats analyze_top_level(std::span<const ConvexRegion> regions, const TopLevelOptions& options,
                                std::span<const Vec3> points);

/// A node as custom actions see it.
struct NodeVisit {
  uint32_t index = 0, parent = kNoTriangle, level = 0;
  const Bvh::Node* node = nullptr;
};
/// Calls `per_node` for every node, parents before children, left before right, then `at_end` once.
void visit_nodes(const Bvh& bvh, const std::function<void(const NodeVisit&)>& per_node,
                 const std::function<void()>& at_end = {});
/// The same over a top level (level and node only).
void visit_nodes(const TopLevel& top_level, const std::function<void(const TopLevel::Node&, uint32_t level)>& per_node,
                 const std::function<void()>& at_end = {});

/// One row per node, by index: index, parent, level, first_child (-1 where there is none), triangles, the box, measure,
/// probability, cost (its share of the tree's estimated cost), overlap with its sibling (common projected area / the
/// smaller one's, plain and culled; needs `area`), and what the log knows (axis, orientations, fallback, forced,
/// quality, ratio; needs `log`). NaN where a value does not exist; `area` and `log` may be null.
struct NodeTable {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
};
NodeTable tabulate_nodes(const Bvh& bvh, const RayMeasure& measure, const AreaGeometry* area, const BuildLog* log,
                         const CostModel& costs = {});

/// The metrics of a tree as a row of the field table. All but `tree` may be null. `trace` gives the costs of the rays
/// through the tree, `fallback` those with the global tree behind it; the hit ratio is the latter's where both are
/// given.
FieldValues collect_fields(const TreeStats& tree, const OverlapStats* overlap, const BuildStats* build,
                           const TraceStats* trace, const FallbackStats* fallback);
/// The metrics of a top level.
FieldValues collect_fields(const TopLevelStats& top_level);

}  // namespace raygrain
