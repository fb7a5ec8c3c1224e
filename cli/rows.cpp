#include "cli/rows.h"

#include <algorithm>

#include <fmt/format.h>

namespace raygrain::cli {

namespace {

using enum FieldId;

constexpr FieldId kTable[] = {kPrunedCost,       kRealCost,    kEstimatedCost,       kCostWithFallback, kHitRatio,
                              kOverlap100Culled, kNodes,       kOrientationsPerNode, kFallbackShare,    kMaxLevel,
                              kMeanLeafDepth,    kMemoryBytes, kBuildSeconds,        kTraceSeconds,     kMismatches};

constexpr FieldId kMain[] = {kEstimatedCost, kRealCost,         kPrunedCost,          kCostWithFallback,
                             kHitRatio,      kOverlap100Culled, kOrientationsPerNode, kFallbackShare,
                             kNodes,         kMaxLevel,         kMeanLeafDepth,       kBuildSeconds,
                             kTraceSeconds,  kMemoryBytes,      kMismatches};

/// What a ratio that no rays can have means.
std::string verdict_of(FieldId id, double value) {
  if (id != kBreakEvenHitRatio) return "";
  return value > 1 ? "never: " : value < 0 ? "always: " : "";
}

}  // namespace

std::span<const FieldId> table_columns() {
  return kTable;
}

std::vector<FieldId> all_columns(std::span<const ReportRow> rows) {
  std::vector<FieldId> columns(std::begin(kMain), std::end(kMain));
  for (size_t i = 0; i < fields().size(); ++i) {
    const FieldId id{i};
    if (std::find(columns.begin(), columns.end(), id) != columns.end()) continue;
    if (std::any_of(rows.begin(), rows.end(), [&](const ReportRow& row) { return row.values.has(id); }))
      columns.push_back(id);
  }
  return columns;
}

std::string row_listing(const ReportRow& row) {
  std::string text;
  for (const FieldId id : all_columns({&row, 1})) {
    if (!row.values.has(id)) continue;
    const Field& f = field(id);
    const char* unit = f.unit == "s" ? " s" : "";
    text += fmt::format("  {:<28} {:>12}  {}{}\n", f.name, value_text(id, row.values[id]) + unit,
                        verdict_of(id, row.values[id]), f.meaning);
  }
  return text;
}

std::string rows_json(const std::string& scene, size_t triangles, uint64_t seed, const CommonOptions& common,
                      std::span<const ReportRow> rows) {
  return report_json(scene, triangles, seed, current_environment(common.thread_count()), rows, all_columns(rows));
}

}  // namespace raygrain::cli
