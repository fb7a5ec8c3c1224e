// Aligned tables and geometric means.
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "ratios.h"
#include "structure_rows.h"
#include "suite.h"

namespace raygrain::bench {
namespace {

std::string text(const std::optional<double>& x) {
  return x ? fmt::format("{:.3f}", *x) : "-";
}
std::string speed(double mrays, int digits) {
  return mrays > 0 ? fmt::format("{:.{}f}", mrays, digits) : "-";
}

std::string text(const Differences& d) {
  return d.count == 0 ? "0" : fmt::format("{} (oracle: raygrain right in {} of {})", d.count, d.agreed, d.asked);
}
std::string text_of_differences(const Row& row) {
  if (!row.differences) return "-";
  std::string all = text(*row.differences);
  if (row.sorted_differences && row.sorted_differences->count > 0)
    all += ", sorted rays " + text(*row.sorted_differences);
  return all;
}

enum class Table { kNone, kRows, kStructured, kAreaBuilds, kBuilds, kSizes };

/// A table that goes on needs no new header; another one begins after an empty line.
bool starts(Table table) {
  static Table current = Table::kNone;
  const bool is_new = current != table;
  current = table;
  if (is_new) fmt::print("\n");
  return is_new;
}

double mebibytes(size_t bytes) {
  return static_cast<double>(bytes) / 1048576;
}

std::string break_even(const std::optional<double>& rays) {
  if (!rays) return "-";
  return std::isfinite(*rays) ? fmt::format("{:.3g}", *rays) : "never";
}

void print_structured(const Row& row) {
  constexpr const char* kFormat =
      "{:<17} {:>9} {:<24} {:<6} {:>3} {:>8} {:>8} {:>7} {:>7} {:>7} {:>7} {:>10}  {:<26} {}\n";
  if (starts(Table::kStructured))
    fmt::print(kFormat, "scene", "triangles", "rays", "api", "thr", "Mrays/s", "Embree", "best", "sorted", "single",
               "global", "break-even", "best mode", "differences");
  const std::string name = row.turn >= 0 ? fmt::format("{} {}", row.rays, row.turn) : row.rays;
  const std::string last = row.cost && row.global_cost
                               ? fmt::format("cost {:.2f}, of the world's tree {:.2f}", *row.cost, *row.global_cost)
                               : text_of_differences(row);
  const std::string mode = row.embree_best_mode.empty() ? "-" : row.embree_best_mode;
  fmt::print(kFormat, row.scene, row.triangles, name, row.api, row.threads, speed(row.raygrain_mrays, 2),
             speed(row.embree_best_mrays, 2), text(ratio_best(row)), text(ratio_sorted(row)), text(ratio_single(row)),
             text(ratio_global(row)), break_even(row.break_even_rays), mode, last);
  std::fflush(stdout);
}

}  // namespace

void report(const Row& row, Results& results) {
  results.rows.push_back(row);
  if (row.suite == "rays") return print_structured(row);
  constexpr const char* kFormat =
      "{:<18} {:>9} {:<16} {:<8} {:<12} {:>3} {:>9} {:<18} {:>9} {:>7} {:>9} {:>7}  {:<26} {}\n";
  if (starts(Table::kRows))
    fmt::print(kFormat, "scene", "triangles", "rays", "query", "api", "thr", "Mrays/s", "tree", "Embree 1", "ratio",
               "best", "ratio", "best mode", "differences");
  fmt::print(kFormat, row.scene, row.triangles, row.rays, row.query, row.api, row.threads,
             fmt::format("{:.3f}", row.raygrain_mrays), row.tree, speed(row.embree_single_mrays, 3),
             text(ratio_single(row)), speed(row.embree_best_mrays, 3), text(ratio_best(row)), row.embree_best_mode,
             text_of_differences(row));
  std::fflush(stdout);
}

void report(const AreaBuildRow& row, Results& results) {
  results.area_builds.push_back(row);
  constexpr const char* kFormat = "{:<17} {:>9} {:<9} {:>3} {:>9} {:>12} {:>7} {:>8} {:>10} {:>7} {:>10} {:>7}\n";
  if (starts(Table::kAreaBuilds))
    fmt::print(kFormat, "scene", "triangles", "structure", "thr", "build s", "best tree s", "/ best", "MiB",
               "trees MiB", "/ trees", "wide MiB", "/ wide");
  const auto share = [&](size_t bytes) { return text(ratio(mebibytes(row.memory_bytes), mebibytes(bytes))); };
  fmt::print(kFormat, row.scene, row.triangles, row.structure, row.threads, fmt::format("{:.4f}", row.build_seconds),
             fmt::format("{:.4f}", row.global_best_build_seconds),
             text(ratio(row.build_seconds, row.global_best_build_seconds)),
             fmt::format("{:.2f}", mebibytes(row.memory_bytes)),
             fmt::format("{:.2f}", mebibytes(row.global_memory_bytes)), share(row.global_memory_bytes),
             fmt::format("{:.2f}", mebibytes(row.global_wide_memory_bytes)), share(row.global_wide_memory_bytes));
  std::fflush(stdout);
}

void report(const BuildRow& row, Results& results) {
  results.builds.push_back(row);
  constexpr const char* kFormat = "{:<18} {:>9} {:<9} {:>3} {:>9} {:>12} {:>9} {:<7} {:>7} {:>9} {:>9} {:>7} {:>9}\n";
  if (starts(Table::kBuilds))
    fmt::print(kFormat, "scene", "triangles", "preset", "thr", "seconds", "Mtriangles/s", "Embree", "quality", "ratio",
               "MiB", "Embree", "ratio", "SAH cost");
  fmt::print(kFormat, row.scene, row.triangles, row.preset, row.threads, fmt::format("{:.4f}", row.raygrain_seconds),
             fmt::format("{:.2f}", static_cast<double>(row.triangles) / row.raygrain_seconds * 1e-6),
             fmt::format("{:.4f}", row.embree_seconds), row.embree_quality, text(ratio_of(row)),
             fmt::format("{:.2f}", mebibytes(row.raygrain_bytes)), fmt::format("{:.2f}", mebibytes(row.embree_bytes)),
             text(ratio(mebibytes(row.raygrain_bytes), mebibytes(row.embree_bytes))),
             fmt::format("{:.2f}", row.sah_cost));
  std::fflush(stdout);
}

void report(const SizeRow& row, Results& results) {
  results.sizes.push_back(row);
  constexpr const char* kFormat = "{:<18} {:>9} {:<26} {:>9} {:>3} {:>9} {:>9} {:>9} {:>9} {:>13} {:>13} {:>13}\n";
  if (starts(Table::kSizes))
    fmt::print(kFormat, "scene", "triangles", "rays", "a call", "thr", "batch ns", "single ns", "array ns", "global ns",
               "single/batch", "global/batch", "global/array");
  const auto time = [](double ns) { return ns > 0 ? fmt::format("{:.1f}", ns) : "-"; };
  fmt::print(kFormat, row.scene, row.triangles, row.rays, row.size, row.threads, time(row.batch), time(row.single),
             time(row.array), time(row.global), text(row.single > 0 ? ratio(row.single, row.batch) : std::nullopt),
             text(ratio(row.global, row.batch)), text(ratio(row.global, row.array)));
  std::fflush(stdout);
}

void print_summary(const Results& results) {
  fmt::print("\ngeometric means of ratios (above 1: raygrain is faster)\n");
  for (const auto& [name, m] : means_of_rows(results))
    fmt::print("{:<36} to Embree's best single rays {}, to its best mode {}\n", name, text(m.single.value()),
               text(m.best.value()));
  for (const auto& [name, m] : means_of_sets(results))
    fmt::print("{:<48} to best mode {}, on sorted rays {}, to single rays {}, to the global tree {}\n", name,
               text(m.best.value()), text(m.sorted.value()), text(m.single.value()), text(m.global.value()));
  for (const auto& [name, mean] : means_of_builds(results)) fmt::print("{:<36} {}\n", name, text(mean.value()));
  fmt::print("\nspeed on all threads by that on one\n");
  for (const auto& [name, m] : scaling(results))
    fmt::print("{:<36} raygrain {}, Embree's single rays {}\n", name, text(m.single.value()), text(m.best.value()));
}

}  // namespace raygrain::bench
