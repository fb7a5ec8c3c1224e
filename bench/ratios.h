// Ratios of rows, and their geometric means over scenes.
#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "suite.h"

namespace raygrain::bench {

/// Above 1: raygrain is faster. Nothing where one was not measured.
std::optional<double> ratio(double ours, double theirs);
std::optional<double> ratio_single(const Row& row);
std::optional<double> ratio_best(const Row& row);
std::optional<double> ratio_sorted(const Row& row);
std::optional<double> ratio_global(const Row& row);
std::optional<double> ratio_of(const BuildRow& row);

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

  void add(const Row& row);
};

/// Keys: SUITE_API_N_threads, and the same by query.
std::map<std::string, Means> means_of_rows(const Results& results);
/// Of rays with structure. Keys: rays_SET_API_N_threads.
std::map<std::string, Means> means_of_sets(const Results& results);
/// Keys: build_PRESET_N_threads.
std::map<std::string, GeometricMean> means_of_builds(const Results& results);
/// How much faster many threads are than one: of raygrain and of the peer's single rays. Keys: SUITE_API_N_threads.
std::map<std::string, Means> scaling(const Results& results);

}  // namespace raygrain::bench
