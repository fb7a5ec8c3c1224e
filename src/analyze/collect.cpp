#include "raygrain/analyze.h"

namespace raygrain {
namespace {

using enum FieldId;

double number(size_t value) {
  return static_cast<double>(value);
}

void set_tree(FieldValues& values, const TreeStats& tree) {
  values[kEstimatedCost] = tree.estimated_cost;
  values[kNodes] = number(tree.nodes);
  values[kLeaves] = number(tree.leaves);
  values[kTriangles] = number(tree.triangles);
  values[kTrianglesPerLeaf] = tree.triangles_per_leaf;
  values[kMaxTrianglesPerLeaf] = number(tree.max_triangles_per_leaf);
  values[kMaxLevel] = number(tree.max_level);
  values[kMeanLeafDepth] = tree.mean_leaf_depth;
  values[kSmallChildRatio] = tree.small_child_ratio;
  values[kLargeChildRatio] = tree.large_child_ratio;
  values[kMemoryBytes] = number(tree.memory_bytes);
  values[kPaperMemoryBytes] = number(tree.paper_memory_bytes);
}

void set_overlap(FieldValues& values, const OverlapStats& overlap) {
  constexpr std::array kPlain{kOverlap4, kOverlap7, kOverlap10, kOverlap15, kOverlap100};
  constexpr std::array kCulled{kOverlap4Culled, kOverlap7Culled, kOverlap10Culled, kOverlap15Culled, kOverlap100Culled};
  static_assert(kPlain.size() == kOverlapLevels.size() && kCulled.size() == kOverlapLevels.size());
  for (size_t i = 0; i < kOverlapLevels.size(); ++i) {
    values[kPlain[i]] = overlap.plain[i];
    values[kCulled[i]] = overlap.culled[i];
  }
}

void set_build(FieldValues& values, const BuildStats& build) {
  values[kOrientationsPerNode] = build.orientations_per_node;
  values[kFallbackShare] = build.fallback_share;
  values[kBuildSeconds] = build.times.total;
  values[kOrientationSeconds] = build.times.orientations;
  values[kCandidateSeconds] = build.times.candidates;
  values[kPartitionSeconds] = build.times.partition;
  values[kStopSeconds] = build.times.stop;
  values[kNodeSeconds] = build.times.nodes;
}

void set_trace(FieldValues& values, const TraceStats& trace) {
  values[kRays] = values[kServedRays] = number(trace.rays);
  values[kRealCost] = trace.real_cost;
  values[kRealCostDeviation] = trace.real_cost_deviation;
  values[kPrunedCost] = trace.pruned_cost;
  values[kHitRatio] = trace.hit_ratio;
  values[kInnerHits] = trace.inner_hits;
  values[kLeafHits] = trace.leaf_hits;
  values[kLeafTriangles] = trace.leaf_triangles;
}

void set_fallback(FieldValues& values, const FallbackStats& fallback) {
  values[kRays] = number(fallback.rays);
  if (!values.has(kServedRays)) values[kServedRays] = number(fallback.served);
  values[kCostWithFallback] = fallback.cost_with_fallback;
  values[kGlobalCost] = fallback.global_cost;
  values[kLocalMissCost] = fallback.local_miss_cost;
  values[kHitRatio] = fallback.hit_ratio;
  values[kBreakEvenHitRatio] = fallback.break_even;
}

}  // namespace

FieldValues collect_fields(const TreeStats& tree, const OverlapStats* overlap, const BuildStats* build,
                           const TraceStats* trace, const FallbackStats* fallback) {
  FieldValues values;
  set_tree(values, tree);
  if (overlap != nullptr) set_overlap(values, *overlap);
  if (build != nullptr) set_build(values, *build);
  if (trace != nullptr) set_trace(values, *trace);
  if (fallback != nullptr) set_fallback(values, *fallback);
  return values;
}

FieldValues collect_fields(const TopLevelStats& top_level) {
  FieldValues values;
  values[kTopLevelNodes] = number(top_level.nodes);
  values[kTopLevelLeaves] = number(top_level.leaves);
  values[kTopLevelAreasPerLeaf] = top_level.areas_per_leaf;
  values[kTopLevelFalseCandidates] = top_level.false_candidates;
  values[kTopLevelMemoryBytes] = number(top_level.memory_bytes);
  values[kTopLevelPaperMemoryBytes] = number(top_level.paper_memory_bytes);
  values[kTopLevelBuildSeconds] = top_level.build_seconds;
  values[kTopLevelQuerySeconds] = top_level.query_seconds;
  return values;
}

}  // namespace raygrain
