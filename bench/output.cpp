// The aligned table, geometric means, and JSON.
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "raygrain/io.h"
#include "raygrain/report.h"

#include "structure_rows.h"
#include "suite.h"

namespace raygrain::bench {
namespace {

using Json = nlohmann::ordered_json;

/// Above 1: raygrain is faster. Nothing where the peer was not measured.
std::optional<double> ratio(double ours, double theirs) {
  return theirs > 0 && std::isfinite(theirs) ? std::optional(ours / theirs) : std::nullopt;
}
std::optional<double> ratio_single(const Row& row) {
  return ratio(row.raygrain_mrays, row.embree_single_mrays);
}
std::optional<double> ratio_best(const Row& row) {
  return ratio(row.raygrain_mrays, row.embree_best_mrays);
}
std::optional<double> ratio_of(const BuildRow& row) {
  return row.embree_bytes > 0 ? ratio(row.embree_seconds, row.raygrain_seconds) : std::nullopt;
}

std::optional<double> ratio_sorted(const Row& row) {
  return ratio(row.raygrain_mrays, row.embree_sorted_mrays);
}
std::optional<double> ratio_global(const Row& row) {
  return ratio(row.raygrain_mrays, row.global_mrays);
}

std::string text(const std::optional<double>& x) {
  return x ? fmt::format("{:.3f}", *x) : "-";
}
Json to_json(const std::optional<double>& x) {
  return x ? Json(*x) : Json();
}

class GeometricMean {
 public:
  void add(const std::optional<double>& x) {
    if (!x || !(*x > 0)) return;
    sum_ += std::log(*x);
    ++count_;
  }
  std::optional<double> value() const { return count_ > 0 ? std::optional(std::exp(sum_ / count_)) : std::nullopt; }

 private:
  double sum_ = 0;
  int count_ = 0;
};

struct Means {
  GeometricMean single, best, sorted, global;

  void add(const Row& row) {
    single.add(ratio_single(row));
    best.add(ratio_best(row));
    sorted.add(ratio_sorted(row));
    global.add(ratio_global(row));
  }
};

/// Keys: SUITE_API_N_threads, and the same by query.
std::map<std::string, Means> means_of_rows(const Results& results) {
  std::map<std::string, Means> all;
  for (const Row& row : results.rows)
    for (const std::string& query : {std::string(), row.query + "_"}) {
      Means& m = all[fmt::format("{}_{}_{}{}_threads", row.suite, row.api, query, row.threads)];
      m.add(row);
    }
  return all;
}

/// Of rays with structure. Keys: rays_SET_API_N_threads.
std::map<std::string, Means> means_of_sets(const Results& results) {
  std::map<std::string, Means> all;
  for (const Row& row : results.rows)
    if (row.suite == "rays") all[fmt::format("rays_{}_{}_{}_threads", row.rays, row.api, row.threads)].add(row);
  return all;
}

std::map<std::string, GeometricMean> means_of_builds(const Results& results) {
  std::map<std::string, GeometricMean> all;
  for (const BuildRow& row : results.builds)
    all[fmt::format("build_{}_{}_threads", row.preset, row.threads)].add(ratio_of(row));
  return all;
}

/// How much faster many threads are than one: of raygrain and of the peer's single rays. Keys: SUITE_API_N_threads.
std::map<std::string, Means> scaling(const Results& results) {
  std::map<std::string, const Row*> on_one;
  std::map<std::string, Means> all;
  for (const Row& row : results.rows) {
    const std::string key = row.suite + '/' + row.scene + '/' + row.rays + '/' + row.query + '/' + row.api;
    if (row.threads == 1) on_one[key] = &row;
    const auto one = on_one.find(key);
    if (row.threads == 1 || one == on_one.end()) continue;
    Means& m = all[fmt::format("{}_{}_{}_threads", row.suite, row.api, row.threads)];
    m.single.add(ratio(row.raygrain_mrays, one->second->raygrain_mrays));
    m.best.add(ratio(row.embree_single_mrays, one->second->embree_single_mrays));
  }
  return all;
}

std::string text_of_differences(const Row& row) {
  if (row.embree_single_mrays == 0) return "-";
  return row.differences == 0 ? "0"
                              : fmt::format("{} (oracle: raygrain right in {} of {})", row.differences,
                                            row.oracle_agrees, row.oracle_asked);
}

enum class Table { kNone, kRows, kStructured, kBuilds, kSizes };

/// A table that goes on needs no new header.
bool starts(Table table) {
  static Table current = Table::kNone;
  const bool is_new = current != table;
  current = table;
  return is_new;
}

double mebibytes(size_t bytes) {
  return static_cast<double>(bytes) / 1048576;
}

Json to_json(const Row& r) {
  Json json{{"suite", r.suite},
            {"scene", r.scene},
            {"triangles", r.triangles},
            {"rays", r.rays},
            {"query", r.query},
            {"api", r.api},
            {"threads", r.threads},
            {"raygrain_mrays", r.raygrain_mrays},
            {"raygrain_tree", r.tree},
            {"embree_single_mrays", r.embree_single_mrays},
            {"embree_single_mode", r.embree_single_mode},
            {"embree_best_mrays", r.embree_best_mrays},
            {"embree_best_mode", r.embree_best_mode},
            {"ratio_single", to_json(ratio_single(r))},
            {"ratio_best", to_json(ratio_best(r))},
            {"differences", r.differences}};
  if (r.suite != "rays") return json;
  const auto rays = [](double count) { return std::isfinite(count) ? Json(std::ceil(count)) : Json(); };
  json.update({{"embree_sorted_mrays", r.embree_sorted_mrays},
               {"embree_sorted_mode", r.embree_sorted_mode},
               {"ratio_sorted", to_json(ratio_sorted(r))},
               {"global_mrays", r.global_mrays},
               {"ratio_global", to_json(ratio_global(r))},
               {"build_seconds", r.build_seconds},
               {"memory_bytes", r.memory_bytes},
               {"break_even_rays", rays(r.break_even_rays)}});
  if (r.turn >= 0) json.update({{"turn", r.turn}, {"cost", r.cost}, {"global_cost", r.global_cost}});
  return json;
}

Json to_json(const BuildRow& b) {
  return {{"scene", b.scene},
          {"triangles", b.triangles},
          {"preset", b.preset},
          {"threads", b.threads},
          {"raygrain_seconds", b.raygrain_seconds},
          {"embree_seconds", b.embree_seconds},
          {"embree_quality", b.embree_quality},
          {"ratio", to_json(ratio_of(b))},
          {"raygrain_bytes", b.raygrain_bytes},
          {"embree_bytes", b.embree_bytes},
          {"sah_cost", b.sah_cost}};
}

Json to_json(const SizeRow& r) {
  return {{"scene", r.scene},      {"triangles", r.triangles}, {"rays", r.rays},
          {"size", r.size},        {"threads", r.threads},     {"batch_ns", r.batch},
          {"single_ns", r.single}, {"array_ns", r.array},      {"global_ns", r.global}};
}

Json geometric_means(const Results& results) {
  Json json = Json::object();
  for (const auto& [name, m] : means_of_rows(results))
    json[name] = {{"ratio_single", to_json(m.single.value())}, {"ratio_best", to_json(m.best.value())}};
  for (const auto& [name, m] : means_of_sets(results))
    json[name] = {{"ratio_single", to_json(m.single.value())},
                  {"ratio_best", to_json(m.best.value())},
                  {"ratio_sorted", to_json(m.sorted.value())},
                  {"ratio_global", to_json(m.global.value())}};
  for (const auto& [name, mean] : means_of_builds(results)) json[name] = {{"ratio", to_json(mean.value())}};
  for (const auto& [name, m] : scaling(results))
    json["scaling_" + name] = {{"raygrain", to_json(m.single.value())}, {"embree_single", to_json(m.best.value())}};
  return json;
}

}  // namespace

namespace {

void print_structured(const Row& row) {
  constexpr const char* kFormat =
      "{:<14} {:>8} {:<24} {:<7} {:>3} {:>8} {:>8} {:>7} {:>7} {:>7} {:>7} {:>8} {:>8} {:>10}  {:<24} {}\n";
  if (starts(Table::kStructured))
    fmt::print(kFormat, "\nscene", "triangles", "rays", "api", "thr", "Mrays/s", "Embree", "best", "sorted", "single",
               "global", "build s", "MiB", "break-even", "best mode", "differences");
  const std::string name = row.turn >= 0 ? fmt::format("{} {}", row.rays, row.turn) : row.rays;
  const std::string difference = row.turn >= 0
                                     ? fmt::format("cost {:.2f}, of the world's tree {:.2f}", row.cost, row.global_cost)
                                     : text_of_differences(row);
  fmt::print(kFormat, row.scene, row.triangles, name, row.api, row.threads, fmt::format("{:.2f}", row.raygrain_mrays),
             fmt::format("{:.2f}", row.embree_best_mrays), text(ratio_best(row)), text(ratio_sorted(row)),
             text(ratio_single(row)), text(ratio_global(row)), fmt::format("{:.3f}", row.build_seconds),
             fmt::format("{:.2f}", mebibytes(row.memory_bytes)), fmt::format("{:.3g}", row.break_even_rays),
             row.embree_best_mode, difference);
  std::fflush(stdout);
}

}  // namespace

void report(const Row& row, Results& results) {
  results.rows.push_back(row);
  if (row.suite == "rays") return print_structured(row);
  constexpr const char* kFormat =
      "{:<18} {:>9} {:<16} {:<8} {:<12} {:>3} {:>9} {:<18} {:>9} {:>7} {:>9} {:>7}  {:<26} {}\n";
  if (starts(Table::kRows))
    fmt::print(kFormat, "\nscene", "triangles", "rays", "query", "api", "thr", "Mrays/s", "tree", "Embree 1", "ratio",
               "best", "ratio", "best mode", "differences");
  fmt::print(kFormat, row.scene, row.triangles, row.rays, row.query, row.api, row.threads,
             fmt::format("{:.3f}", row.raygrain_mrays), row.tree, fmt::format("{:.3f}", row.embree_single_mrays),
             text(ratio_single(row)), fmt::format("{:.3f}", row.embree_best_mrays), text(ratio_best(row)),
             row.embree_best_mode, text_of_differences(row));
  std::fflush(stdout);
}

void report(const BuildRow& row, Results& results) {
  results.builds.push_back(row);
  constexpr const char* kFormat = "{:<18} {:>9} {:<9} {:>3} {:>9} {:>11} {:>9} {:<7} {:>7} {:>9} {:>9} {:>7} {:>9}\n";
  if (starts(Table::kBuilds))
    fmt::print(kFormat, "\nscene", "triangles", "preset", "thr", "seconds", "Mtriangles/s", "Embree", "quality",
               "ratio", "MiB", "Embree", "ratio", "SAH cost");
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
    fmt::print(kFormat, "\nscene", "triangles", "rays", "a call", "thr", "batch ns", "single ns", "array ns",
               "global ns", "single/batch", "global/batch", "global/array");
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

void save_json(const Results& results, const std::string& path) {
  const Environment environment = current_environment(0);
  Json json{{"environment",
             {{"commit", environment.commit},
              {"compiler", environment.compiler},
              {"cpu", environment.cpu},
              {"threads", environment.threads}}}};
  json["rows"] = Json::array();
  for (const Row& row : results.rows) json["rows"].push_back(to_json(row));
  json["builds"] = Json::array();
  for (const BuildRow& row : results.builds) json["builds"].push_back(to_json(row));
  json["sizes"] = Json::array();
  for (const SizeRow& row : results.sizes) json["sizes"].push_back(to_json(row));
  json["structures"] = Json::array();
  for (const StructureRow& row : results.structures) json["structures"].push_back(to_json(row));
  json["geomean"] = geometric_means(results);
  write_file_atomically(path, [&](std::ostream& out) { out << json.dump(2) << '\n'; });
}

}  // namespace raygrain::bench
