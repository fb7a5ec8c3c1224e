// What a tree is worth and what rays really cost: pure functions over finished trees, top levels and ray sets.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "raygrain/accelerator.h"
#include "raygrain/area.h"
#include "raygrain/build.h"
#include "raygrain/bvh.h"
#include "raygrain/fields.h"
#include "raygrain/measure.h"
#include "raygrain/ray.h"

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
  double small_child_ratio = 0,
         large_child_ratio = 0;  // mean over inner nodes of measure(smaller, larger child) / parent
  size_t memory_bytes = 0;       // measured
  size_t paper_memory_bytes =
      0;  // the paper's section 9.6 formula: 40 B per inner node, 32 B + 8 B per triangle per leaf
};
TreeStats analyze(const Bvh& bvh, const RayMeasure& measure, const CostModel& costs = {});

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
  double hit_ratio = 0;    // hits / rays
  double inner_hits = 0, leaf_hits = 0, leaf_triangles = 0;  // means per ray, full traversal
};
TraceStats analyze_rays(const Bvh& bvh, const TriangleMesh& mesh, std::span<const Ray> rays,
                        const CostModel& costs = {}, unsigned threads = 0);

/// Full-traversal cost of one ray from its counters.
constexpr double ray_cost(const TraceCounters& c, const CostModel& costs) {
  return static_cast<double>(costs.inner) * static_cast<double>(c.inner_hits) +
         static_cast<double>(costs.triangle) * static_cast<double>(c.leaf_triangles);
}

/// Rays through a local tree with the global one behind it: what an area is worth.
struct FallbackStats {
  size_t rays = 0, served = 0;
  double local_cost = 0;  // mean real cost in the local tree over the rays that it served
  double cost_with_fallback =
      0;                   // mean real cost over all rays: local, plus global for rays without an accepted local hit
  double global_cost = 0;  // mean real cost of the same rays in the global tree alone
  double local_miss_cost = 0;       // mean global real cost of the rays without an accepted local hit
  double hit_ratio = 0;             // accepted local hits / rays
  double break_even_hit_ratio = 0;  // (C_local + C_miss - C_global) / C_miss: above it the local tree pays; may be < 0
};
FallbackStats analyze_fallback(const LocalTree& local, const Bvh& global, const TriangleMesh& mesh,
                               std::span<const Ray> rays, const CostModel& costs = {}, unsigned threads = 0);

/// The top level: shape, and how sharp its answers are.
struct TopLevelStats {
  size_t nodes = 0, leaves = 0;
  double areas_per_leaf = 0;
  double false_candidates = 0;  // mean per query point: listed regions that do not contain the point
  size_t memory_bytes = 0;
  double query_seconds = 0;  // mean per query
};
TopLevelStats analyze(const TopLevel& top_level, std::span<const ConvexRegion> regions, std::span<const Vec3> points);

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

/// One row per node for `analyze --nodes`: index, parent, level, first child, triangle count, box, measure,
/// probability, cost, overlap with sibling and what the log knows. `area` (for overlap) and `log` may be null.
struct NodeTable {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
};
NodeTable tabulate_nodes(const Bvh& bvh, const RayMeasure& measure, const AreaGeometry* area, const BuildLog* log,
                         const CostModel& costs = {});

/// All metrics of a tree in one row of the field table. `area`, `log`, `trace` and `fallback` may be null.
FieldValues collect_fields(const TreeStats& tree, const OverlapStats* overlap, const BuildStats* build,
                           const TraceStats* trace, const FallbackStats* fallback);

}  // namespace raygrain
