#include "structure_rows.h"

#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace raygrain::bench {
namespace {

using Json = nlohmann::ordered_json;

/// Embree was not there, or nothing was measured.
Json ratio(double theirs, double ours) {
  return theirs > 0 && ours > 0 ? Json(theirs / ours) : Json();
}

std::string text(double theirs, double ours) {
  return theirs > 0 && ours > 0 ? fmt::format("{:.2f}", theirs / ours) : "-";
}

}  // namespace

void report(const StructureRow& row, Results& results) {
  constexpr const char* kFormat =
      "{:<14} {:>8} {:<24} {:<22} {:<6} {:>3} {:>7} {:>8} {:>6} {:>7} {:>6} {:>7} {:>6} {:>7} {:>6}  {:<26} {}\n";
  if (results.structures.empty())
    fmt::print(kFormat, "\nscene", "triangles", "rays", "structure", "api", "thr", "ns/ray", "Embree 1", "ratio",
               "best", "ratio", "build s", "global", "MiB", "global", "best mode", "unlike the global tree");
  results.structures.push_back(row);
  const double mebibytes = static_cast<double>(row.memory_bytes) / 1048576;
  fmt::print(kFormat, row.scene, row.triangles, row.rays, row.structure, row.api, row.threads,
             fmt::format("{:.1f}", row.nanoseconds), fmt::format("{:.1f}", row.embree_single_nanoseconds),
             text(row.embree_single_nanoseconds, row.nanoseconds), fmt::format("{:.1f}", row.embree_best_nanoseconds),
             text(row.embree_best_nanoseconds, row.nanoseconds), fmt::format("{:.3f}", row.build_seconds),
             text(row.build_seconds, row.global_build_seconds), fmt::format("{:.2f}", mebibytes),
             text(static_cast<double>(row.memory_bytes), static_cast<double>(row.global_bytes)), row.embree_best_mode,
             row.differences);
  std::fflush(stdout);
}

Json to_json(const StructureRow& r) {
  return {{"suite", "structures"},
          {"scene", r.scene},
          {"triangles", r.triangles},
          {"rays", r.rays},
          {"query", r.query},
          {"structure", r.structure},
          {"api", r.api},
          {"threads", r.threads},
          {"nanoseconds", r.nanoseconds},
          {"embree_single_nanoseconds", r.embree_single_nanoseconds},
          {"embree_single_mode", r.embree_single_mode},
          {"embree_best_nanoseconds", r.embree_best_nanoseconds},
          {"embree_best_mode", r.embree_best_mode},
          {"ratio_single", ratio(r.embree_single_nanoseconds, r.nanoseconds)},
          {"ratio_best", ratio(r.embree_best_nanoseconds, r.nanoseconds)},
          {"build_seconds", r.build_seconds},
          {"ratio_build", ratio(r.build_seconds, r.global_build_seconds)},
          {"memory_bytes", r.memory_bytes},
          {"ratio_memory", ratio(static_cast<double>(r.memory_bytes), static_cast<double>(r.global_bytes))},
          {"differences", r.differences}};
}

}  // namespace raygrain::bench
