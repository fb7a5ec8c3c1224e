#include "raygrain/fields.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace raygrain {
namespace {

TEST(Fields, OneEntryPerIdWithUniqueNames) {
  ASSERT_EQ(fields().size(), static_cast<size_t>(FieldId::kCount));
  std::set<std::string_view> names;
  for (const Field& f : fields()) {
    SCOPED_TRACE(std::string(f.name));
    EXPECT_TRUE(names.insert(f.name).second);
    EXPECT_EQ(f.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"), std::string_view::npos);
    EXPECT_FALSE(f.meaning.empty());
    EXPECT_EQ(f.meaning.back(), '.');
    EXPECT_LT(f.lowest, f.highest);
  }
}

TEST(Fields, NamesOfTheComparisonFile) {
  EXPECT_EQ(field(FieldId::kEstimatedCost).name, "estimated_cost");
  EXPECT_EQ(field(FieldId::kRealCost).name, "real_cost");
  EXPECT_EQ(field(FieldId::kPrunedCost).name, "pruned_cost");
  EXPECT_EQ(field(FieldId::kCostWithFallback).name, "cost_with_fallback");
  EXPECT_EQ(field(FieldId::kHitRatio).name, "hit_ratio");
  EXPECT_EQ(field(FieldId::kOverlap100Culled).name, "overlap");
  EXPECT_EQ(field(FieldId::kOverlap100).name, "overlap100");
  EXPECT_EQ(field(FieldId::kOverlap4Culled).name, "overlap4_culled");
  EXPECT_EQ(field(FieldId::kOrientationsPerNode).name, "orientations_per_node");
  EXPECT_EQ(field(FieldId::kFallbackShare).name, "fallback_share");
  EXPECT_EQ(field(FieldId::kNodes).name, "nodes");
  EXPECT_EQ(field(FieldId::kMaxLevel).name, "max_level");
  EXPECT_EQ(field(FieldId::kMeanLeafDepth).name, "mean_leaf_depth");
  EXPECT_EQ(field(FieldId::kBuildSeconds).name, "build_seconds");
  EXPECT_EQ(field(FieldId::kTraceSeconds).name, "trace_seconds");
  EXPECT_EQ(field(FieldId::kMemoryBytes).name, "memory_bytes");
  EXPECT_EQ(field(FieldId::kMismatches).name, "mismatches");
}

TEST(Fields, OnlyTimesVaryBetweenRuns) {
  for (const Field& f : fields()) {
    SCOPED_TRACE(std::string(f.name));
    EXPECT_EQ(f.deterministic, f.unit != "s");
    EXPECT_EQ(f.unit == "s", f.name.ends_with("_seconds"));
    EXPECT_EQ(f.unit == "B", f.name.ends_with("_bytes"));
  }
}

TEST(Fields, ValuesStartUnmeasured) {
  FieldValues values;
  for (size_t i = 0; i < fields().size(); ++i) EXPECT_FALSE(values.has(FieldId{i}));
  values[FieldId::kNodes] = 3;
  EXPECT_TRUE(values.has(FieldId::kNodes));
  EXPECT_EQ(values[FieldId::kNodes], 3);
}

}  // namespace
}  // namespace raygrain
