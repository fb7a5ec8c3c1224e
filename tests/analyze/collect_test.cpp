#include <gtest/gtest.h>

#include "raygrain/analyze.h"

namespace raygrain {
namespace {

TEST(CollectFields, EveryMetricOfATreeFindsItsField) {
  TreeStats tree;
  OverlapStats overlap;
  BuildStats build;
  TraceStats trace;
  FallbackStats fallback;
  double next = 1;  // a different number in each
  const auto count = [&] { return static_cast<size_t>(next++); };
  tree = {next++, count(), count(), count(), next++, count(), static_cast<uint32_t>(count()),
          next++, next++,  next++,  count(), count()};
  for (size_t i = 0; i < kOverlapLevels.size(); ++i) {
    overlap.plain[i] = next++;
    overlap.culled[i] = next++;
  }
  build = {next++, next++, {next++, next++, next++, next++, next++, next++}};
  trace = {count(), count(), next++, next++, next++, next++, next++, next++, next++};
  fallback = {count(), count(), next++, next++, next++, next++, next++, next++};
  const FieldValues all = collect_fields(tree, &overlap, &build, &trace, &fallback);
  EXPECT_EQ(all[FieldId::kEstimatedCost], tree.estimated_cost);
  EXPECT_EQ(all[FieldId::kLeaves], static_cast<double>(tree.leaves));
  EXPECT_EQ(all[FieldId::kMaxLevel], tree.max_level);
  EXPECT_EQ(all[FieldId::kLargeChildRatio], tree.large_child_ratio);
  EXPECT_EQ(all[FieldId::kPaperMemoryBytes], static_cast<double>(tree.paper_memory_bytes));
  EXPECT_EQ(all[FieldId::kOverlap4], overlap.plain[0]);
  EXPECT_EQ(all[FieldId::kOverlap15Culled], overlap.culled[3]);
  EXPECT_EQ(all[FieldId::kOverlap100Culled], overlap.culled[4]);
  EXPECT_EQ(all[FieldId::kFallbackShare], build.fallback_share);
  EXPECT_EQ(all[FieldId::kPartitionSeconds], build.times.partition);
  EXPECT_EQ(all[FieldId::kPrunedCost], trace.pruned_cost);
  EXPECT_EQ(all[FieldId::kRealCost], trace.real_cost);
  EXPECT_EQ(all[FieldId::kLeafTriangles], trace.leaf_triangles);
  EXPECT_EQ(all[FieldId::kCostWithFallback], fallback.cost_with_fallback);
  EXPECT_EQ(all[FieldId::kHitRatio], fallback.hit_ratio);
  EXPECT_EQ(all[FieldId::kRays], static_cast<double>(fallback.rays));
  EXPECT_EQ(all[FieldId::kServedRays], static_cast<double>(trace.rays)) << "what the deviation is of";
  EXPECT_EQ(all[FieldId::kBreakEvenHitRatio], fallback.break_even);
  std::vector<double> seen;
  for (size_t i = 0; i < fields().size(); ++i) {
    const FieldId id{i};
    const bool is_elsewhere =
        field(id).name.starts_with("top_level") || id == FieldId::kTraceSeconds || id == FieldId::kMismatches;
    EXPECT_EQ(all.has(id), !is_elsewhere) << field(id).name;
    if (all.has(id)) seen.push_back(all[id]);
  }
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(std::adjacent_find(seen.begin(), seen.end()), seen.end()) << "two fields took the same metric";
}

TEST(CollectFields, WhatWasNotMeasuredStaysEmpty) {
  const FieldValues values = collect_fields(TreeStats{}, nullptr, nullptr, nullptr, nullptr);
  EXPECT_TRUE(values.has(FieldId::kNodes));
  EXPECT_FALSE(values.has(FieldId::kOverlap100Culled));
  EXPECT_FALSE(values.has(FieldId::kBuildSeconds));
  EXPECT_FALSE(values.has(FieldId::kRealCost));
  EXPECT_FALSE(values.has(FieldId::kHitRatio));
  FallbackStats fallback;
  fallback.served = 3;
  EXPECT_EQ(collect_fields(TreeStats{}, nullptr, nullptr, nullptr, &fallback)[FieldId::kServedRays], 3);
  TraceStats trace;
  trace.hit_ratio = 0.25;
  EXPECT_EQ(collect_fields(TreeStats{}, nullptr, nullptr, &trace, nullptr)[FieldId::kHitRatio], 0.25);
}

TEST(CollectFields, TopLevelFillsItsOwn) {
  const FieldValues values = collect_fields(TopLevelStats{});
  for (size_t i = 0; i < fields().size(); ++i) {
    EXPECT_EQ(values.has(FieldId{i}), fields()[i].name.starts_with("top_level")) << fields()[i].name;
  }
}

}  // namespace
}  // namespace raygrain
