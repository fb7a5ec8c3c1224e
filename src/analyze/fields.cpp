#include "raygrain/fields.h"

namespace raygrain {
namespace {

struct Row {
  FieldId id;
  Field field;
};

constexpr auto kLow = Better::kLower, kHigh = Better::kHigher, kNone = Better::kNeither;
constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr size_t kFieldCount = static_cast<size_t>(FieldId::kCount);

using enum FieldId;

constexpr std::array<Row, kFieldCount> kRows{{
    // What a ray costs.
    {kEstimatedCost,
     {"estimated_cost", "", 0, kUnlimited, kLow, true,
      "Cost of a ray that the tree's measure predicts: sum over nodes of hit probability times node cost."}},
    {kRealCost,
     {"real_cost", "", 0, kUnlimited, kLow, true,
      "Mean cost of the rays that search the tree, full traversal: 2 per inner box met, 1.2 per triangle of a leaf "
      "met."}},
    {kPrunedCost,
     {"pruned_cost", "", 0, kUnlimited, kLow, true,
      "Mean cost of the same rays when the nearest hit so far prunes the search: what users pay."}},
    {kCostWithFallback,
     {"cost_with_fallback", "", 0, kUnlimited, kLow, true,
      "Mean real cost over all rays: the local tree's, plus the global tree's for rays without an accepted local "
      "hit."}},
    {kGlobalCost,
     {"global_cost", "", 0, kUnlimited, kLow, true, "Mean real cost of the same rays in the global tree alone."}},
    {kHitRatio, {"hit_ratio", "", 0, 1, kHigh, true, "Rays that end with an accepted hit of the tree, per ray."}},
    {kBreakEvenHitRatio,
     {"break_even_hit_ratio", "", -kUnlimited, kUnlimited, kLow, true,
      "Hit ratio above which the local tree with fallback costs less than the global tree alone; above 1: "
      "never, below 0: always."}},
    // Overlap of siblings.
    {kOverlap4,
     {"overlap4", "", 0, 1, kLow, true, "Common projected area of siblings per smaller sibling's, levels 0 to 4."}},
    {kOverlap7,
     {"overlap7", "", 0, 1, kLow, true, "Common projected area of siblings per smaller sibling's, levels 0 to 7."}},
    {kOverlap10,
     {"overlap10", "", 0, 1, kLow, true, "Common projected area of siblings per smaller sibling's, levels 0 to 10."}},
    {kOverlap15,
     {"overlap15", "", 0, 1, kLow, true, "Common projected area of siblings per smaller sibling's, levels 0 to 15."}},
    {kOverlap100,
     {"overlap100", "", 0, 1, kLow, true, "Common projected area of siblings per smaller sibling's, all levels."}},
    {kOverlap4Culled,
     {"overlap4_culled", "", 0, 1, kLow, true, "overlap4 with projections culled to the area's window."}},
    {kOverlap7Culled,
     {"overlap7_culled", "", 0, 1, kLow, true, "overlap7 with projections culled to the area's window."}},
    {kOverlap10Culled,
     {"overlap10_culled", "", 0, 1, kLow, true, "overlap10 with projections culled to the area's window."}},
    {kOverlap15Culled,
     {"overlap15_culled", "", 0, 1, kLow, true, "overlap15 with projections culled to the area's window."}},
    {kOverlap100Culled,
     {"overlap", "", 0, 1, kLow, true,
      "Common projected area of siblings per smaller sibling's, culled to the area's window, all levels."}},
    // What the builder did.
    {kOrientationsPerNode,
     {"orientations_per_node", "", 0, kUnlimited, kLow, true,
      "Split orientations tried per inner node; attempts in nodes that became leaves count too."}},
    {kFallbackShare,
     {"fallback_share", "", 0, 1, kLow, true, "Inner nodes that the decision handed to the fallback, per inner node."}},
    // The tree's shape.
    {kNodes, {"nodes", "", 0, kUnlimited, kLow, true, "Nodes of the tree."}},
    {kLeaves, {"leaves", "", 0, kUnlimited, kNone, true, "Leaves of the tree."}},
    {kTriangles, {"triangles", "", 0, kUnlimited, kNone, true, "Triangles in the tree."}},
    {kTrianglesPerLeaf, {"triangles_per_leaf", "", 0, kUnlimited, kNone, true, "Mean number of triangles in a leaf."}},
    {kMaxTrianglesPerLeaf, {"max_triangles_per_leaf", "", 0, kUnlimited, kLow, true, "Triangles in the fullest leaf."}},
    {kMaxLevel, {"max_level", "", 0, 256, kLow, true, "Depth of the deepest leaf in edges; the root has 0."}},
    {kMeanLeafDepth, {"mean_leaf_depth", "", 0, 256, kLow, true, "Mean depth of a leaf in edges."}},
    {kSmallChildRatio,
     {"small_child_ratio", "", 0, 1, kNone, true, "Mean measure of the smaller child per its parent's, inner nodes."}},
    {kLargeChildRatio,
     {"large_child_ratio", "", 0, 1, kNone, true, "Mean measure of the larger child per its parent's, inner nodes."}},
    // What rays met in full traversal.
    {kInnerHits, {"inner_hits", "", 0, kUnlimited, kLow, true, "Inner boxes that a ray meets, mean, full traversal."}},
    {kLeafHits, {"leaf_hits", "", 0, kUnlimited, kLow, true, "Leaf boxes that a ray meets, mean, full traversal."}},
    {kLeafTriangles,
     {"leaf_triangles", "", 0, kUnlimited, kLow, true, "Triangles of the leaves a ray meets, mean, full traversal."}},
    // Memory and time.
    {kMemoryBytes, {"memory_bytes", "B", 0, kUnlimited, kLow, true, "Memory that the tree holds."}},
    {kPaperMemoryBytes,
     {"paper_memory_bytes", "B", 0, kUnlimited, kLow, true,
      "Memory as the paper counts it: 40 B per node and 4 B per triangle."}},
    {kBuildSeconds, {"build_seconds", "s", 0, kUnlimited, kLow, false, "Time to build the tree, wall clock."}},
    {kOrientationSeconds,
     {"orientation_seconds", "s", 0, kUnlimited, kLow, false, "Part of the build: choosing split orientations."}},
    {kCandidateSeconds,
     {"candidate_seconds", "s", 0, kUnlimited, kLow, false, "Part of the build: pricing candidate planes."}},
    {kPartitionSeconds,
     {"partition_seconds", "s", 0, kUnlimited, kLow, false, "Part of the build: dividing primitives."}},
    {kStopSeconds, {"stop_seconds", "s", 0, kUnlimited, kLow, false, "Part of the build: deciding about leaves."}},
    {kNodeSeconds, {"node_seconds", "s", 0, kUnlimited, kLow, false, "Part of the build: making nodes."}},
    {kTraceSeconds,
     {"trace_seconds", "s", 0, kUnlimited, kLow, false,
      "Time to find the nearest hit of all rays through wide trees, this one first and the global one behind it, "
      "least of three passes."}},
    // Proof, and what the costs were measured with.
    {kMismatches,
     {"mismatches", "", 0, kUnlimited, kLow, true, "Rays whose hit differs in any bit from an independent search's."}},
    {kRays, {"rays", "", 0, kUnlimited, kNone, true, "Rays that were traced."}},
    {kServedRays,
     {"served_rays", "", 0, kUnlimited, kNone, true,
      "Rays of these that the area serves: those that search the tree, over which its costs are means."}},
    {kRealCostDeviation,
     {"real_cost_deviation", "", 0, kUnlimited, kNone, true,
      "Standard deviation of the real cost of a served ray; over the root of served_rays it is the mean's error."}},
    {kLocalMissCost,
     {"local_miss_cost", "", 0, kUnlimited, kLow, true,
      "Mean real cost in the global tree of the rays without an accepted local hit."}},
    // The top level.
    {kTopLevelNodes, {"top_level_nodes", "", 0, kUnlimited, kLow, true, "Nodes of the top level; none for a list."}},
    {kTopLevelLeaves,
     {"top_level_leaves", "", 0, kUnlimited, kNone, true, "Leaves of the top level; none for a list."}},
    {kTopLevelAreasPerLeaf,
     {"top_level_areas_per_leaf", "", 0, kUnlimited, kLow, true, "Mean number of areas that a leaf lists."}},
    {kTopLevelFalseCandidates,
     {"top_level_false_candidates", "", 0, kUnlimited, kLow, true,
      "Mean number of areas listed for a point that do not hold it."}},
    {kTopLevelMemoryBytes,
     {"top_level_memory_bytes", "B", 0, kUnlimited, kLow, true, "Memory that the top level holds."}},
    {kTopLevelPaperMemoryBytes,
     {"top_level_paper_memory_bytes", "B", 0, kUnlimited, kLow, true,
      "Memory as the paper counts it: 56 B per octree node and 4 B per listed area."}},
    {kTopLevelBuildSeconds,
     {"top_level_build_seconds", "s", 0, kUnlimited, kLow, false, "Time to build the top level, wall clock."}},
    {kTopLevelQuerySeconds,
     {"top_level_query_seconds", "s", 0, kUnlimited, kLow, false, "Mean time to look up one point, wall clock."}},
}};

constexpr bool in_order() {
  for (size_t i = 0; i < kFieldCount; ++i) {
    if (static_cast<size_t>(kRows[i].id) != i || kRows[i].field.name.empty()) return false;
  }
  return true;
}
static_assert(in_order(), "one row per FieldId, in the order of the enum");

constexpr std::array<Field, kFieldCount> make_fields() {
  std::array<Field, kFieldCount> result{};
  for (size_t i = 0; i < kFieldCount; ++i) result[i] = kRows[i].field;
  return result;
}
constexpr std::array<Field, kFieldCount> kFields = make_fields();

}  // namespace

std::span<const Field> fields() {
  return kFields;
}

const Field& field(FieldId id) {
  return kFields[static_cast<size_t>(id)];
}

}  // namespace raygrain
