#include "ratios.h"

#include <fmt/format.h>

namespace raygrain::bench {

std::optional<double> ratio(double ours, double theirs) {
  return ours > 0 && theirs > 0 && std::isfinite(theirs) ? std::optional(ours / theirs) : std::nullopt;
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
  if (row.api == "single") return std::nullopt;  // sorted rays come in batches
  return ratio(row.raygrain_mrays, row.embree_sorted_mrays);
}
std::optional<double> ratio_global(const Row& row) {
  return ratio(row.raygrain_mrays, row.global_mrays);
}

void Means::add(const Row& row) {
  single.add(ratio_single(row));
  best.add(ratio_best(row));
  sorted.add(ratio_sorted(row));
  global.add(ratio_global(row));
}

std::map<std::string, Means> means_of_rows(const Results& results) {
  std::map<std::string, Means> all;
  for (const Row& row : results.rows)
    for (const std::string& query : {std::string(), row.query + "_"}) {
      Means& m = all[fmt::format("{}_{}_{}{}_threads", row.suite, row.api, query, row.threads)];
      m.add(row);
    }
  return all;
}

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

}  // namespace raygrain::bench
