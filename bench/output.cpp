// The aligned table, geometric means, and JSON.
#include <cmath>
#include <fstream>
#include <functional>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "raygrain/io.h"
#include "raygrain/report.h"

#include "suite.h"

namespace raygrain::bench {
namespace {

double ratio(double ours, double theirs) {
  return theirs > 0 ? ours / theirs : 0;
}

class GeometricMean {
 public:
  void add(double x) {
    if (!(x > 0)) return;
    sum_ += std::log(x);
    ++count_;
  }
  double value() const { return count_ > 0 ? std::exp(sum_ / count_) : 0; }

 private:
  double sum_ = 0;
  int count_ = 0;
};

struct Means {
  GeometricMean single, best;
};

/// By suite, threads and api.
std::map<std::string, Means> means(const Results& results) {
  std::map<std::string, Means> all;
  for (const Row& row : results.rows) {
    Means& m = all[fmt::format("{}_{}_{}_threads", row.suite, row.api, row.threads)];
    m.single.add(ratio(row.raygrain_mrays, row.embree_single_mrays));
    m.best.add(ratio(row.raygrain_mrays, row.embree_best_mrays));
  }
  return all;
}

}  // namespace

void print_row(const Row& row) {
  static bool has_header = false;
  if (!has_header)
    fmt::print("{:<16} {:>9} {:<16} {:<8} {:<7} {:>3} {:>9} {:>9} {:>7} {:>9} {:>7}  {:<26} {}\n", "scene", "triangles",
               "rays", "query", "api", "thr", "raygrain", "Embree 1", "ratio", "best", "ratio", "best mode",
               "differences");
  has_header = true;
  fmt::print("{:<16} {:>9} {:<16} {:<8} {:<7} {:>3} {:>9.3f} {:>9.3f} {:>7.3f} {:>9.3f} {:>7.3f}  {:<26} {}\n",
             row.scene, row.triangles, row.rays, row.query, row.api, row.threads, row.raygrain_mrays,
             row.embree_single_mrays, ratio(row.raygrain_mrays, row.embree_single_mrays), row.embree_best_mrays,
             ratio(row.raygrain_mrays, row.embree_best_mrays), row.embree_best_mode,
             row.differences == 0 ? "0"
                                  : fmt::format("{} (oracle: raygrain right in {}/{})", row.differences,
                                                row.oracle_agrees, row.oracle_asked));
  std::fflush(stdout);
}

void print_summary(const Results& results) {
  fmt::print("\n{:<16} {:>9} {:<9} {:>3} {:>9} {:>9} {:>7} {:>10} {:>10} {:>9}\n", "build", "triangles", "preset",
             "thr", "raygrain", "Embree", "ratio", "MiB", "Embree", "SAH cost");
  for (const BuildRow& b : results.builds)
    fmt::print("{:<16} {:>9} {:<9} {:>3} {:>7.3f} s {:>7.3f} s {:>7.3f} {:>10.2f} {:>10.2f} {:>9.2f}\n", b.scene,
               b.triangles, b.preset, b.threads, b.raygrain_seconds, b.embree_seconds,
               ratio(b.embree_seconds, b.raygrain_seconds), static_cast<double>(b.raygrain_bytes) / 1048576,
               static_cast<double>(b.embree_bytes) / 1048576, b.sah_cost);
  fmt::print("\ngeometric means of ratios (above 1: raygrain is faster)\n");
  for (const auto& [name, m] : means(results))
    fmt::print("{:<28} to Embree's best single rays {:.3f}, to its best mode {:.3f}\n", name, m.single.value(),
               m.best.value());
}

void save_json(const Results& results, const std::string& path) {
  using Json = nlohmann::ordered_json;
  const Environment environment = current_environment(0);
  Json json{{"environment",
             {{"commit", environment.commit},
              {"compiler", environment.compiler},
              {"cpu", environment.cpu},
              {"threads", environment.threads}}}};
  json["rows"] = Json::array();
  for (const Row& r : results.rows)
    json["rows"].push_back({{"suite", r.suite},
                            {"scene", r.scene},
                            {"triangles", r.triangles},
                            {"rays", r.rays},
                            {"query", r.query},
                            {"api", r.api},
                            {"threads", r.threads},
                            {"raygrain_mrays", r.raygrain_mrays},
                            {"embree_single_mrays", r.embree_single_mrays},
                            {"embree_best_mrays", r.embree_best_mrays},
                            {"embree_best_mode", r.embree_best_mode},
                            {"ratio_single", ratio(r.raygrain_mrays, r.embree_single_mrays)},
                            {"ratio_best", ratio(r.raygrain_mrays, r.embree_best_mrays)},
                            {"differences", r.differences}});
  json["builds"] = Json::array();
  for (const BuildRow& b : results.builds)
    json["builds"].push_back({{"scene", b.scene},
                              {"triangles", b.triangles},
                              {"preset", b.preset},
                              {"threads", b.threads},
                              {"raygrain_seconds", b.raygrain_seconds},
                              {"embree_seconds", b.embree_seconds},
                              {"embree_quality", b.embree_quality},
                              {"ratio", ratio(b.embree_seconds, b.raygrain_seconds)},
                              {"raygrain_bytes", b.raygrain_bytes},
                              {"embree_bytes", b.embree_bytes},
                              {"sah_cost", b.sah_cost}});
  json["geomean"] = Json::object();
  for (const auto& [name, m] : means(results))
    json["geomean"][name] = {{"ratio_single", m.single.value()}, {"ratio_best", m.best.value()}};
  write_file_atomically(path, [&](std::ostream& out) { out << json.dump(2) << '\n'; });
}

}  // namespace raygrain::bench
