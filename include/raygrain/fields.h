// Every metric that raygrain reports, declared once: name, unit, range, meaning. All exporters read this table.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>

namespace raygrain {

/// Indices into `fields()`.
enum class FieldId : size_t {
  kEstimatedCost,
  kRealCost,
  kPrunedCost,
  kCostWithFallback,
  kGlobalCost,
  kHitRatio,
  kBreakEvenHitRatio,
  kOverlap4,
  kOverlap7,
  kOverlap10,
  kOverlap15,
  kOverlap100,
  kOverlap4Culled,
  kOverlap7Culled,
  kOverlap10Culled,
  kOverlap15Culled,
  kOverlap100Culled,
  kOrientationsPerNode,
  kFallbackShare,
  kNodes,
  kLeaves,
  kTriangles,
  kTrianglesPerLeaf,
  kMaxTrianglesPerLeaf,
  kMaxLevel,
  kMeanLeafDepth,
  kSmallChildRatio,
  kLargeChildRatio,
  kInnerHits,
  kLeafHits,
  kLeafTriangles,
  kMemoryBytes,
  kPaperMemoryBytes,
  kBuildSeconds,
  kOrientationSeconds,
  kCandidateSeconds,
  kPartitionSeconds,
  kStopSeconds,
  kNodeSeconds,
  kTraceSeconds,
  kMismatches,
  kRays,
  kServedRays,
  kRealCostDeviation,
  kLocalMissCost,
  kTopLevelNodes,
  kTopLevelLeaves,
  kTopLevelAreasPerLeaf,
  kTopLevelFalseCandidates,
  kTopLevelMemoryBytes,
  kTopLevelPaperMemoryBytes,
  kTopLevelBuildSeconds,
  kTopLevelQuerySeconds,
  kCount
};

enum class Better { kLower, kHigher, kNeither };

struct Field {
  std::string_view name;   // as in JSON and CSV
  std::string_view unit;   // "" for pure numbers
  double lowest, highest;  // range of legal values
  Better better;
  bool deterministic;        // false for times
  std::string_view meaning;  // one sentence
};

/// One entry per FieldId, in order.
std::span<const Field> fields();
const Field& field(FieldId id);

/// A value per field; NaN where not measured.
struct FieldValues {
  std::array<double, static_cast<size_t>(FieldId::kCount)> values;

  FieldValues() { values.fill(std::numeric_limits<double>::quiet_NaN()); }
  double& operator[](FieldId id) { return values[static_cast<size_t>(id)]; }
  double operator[](FieldId id) const { return values[static_cast<size_t>(id)]; }
  bool has(FieldId id) const { return !std::isnan((*this)[id]); }
};

}  // namespace raygrain
