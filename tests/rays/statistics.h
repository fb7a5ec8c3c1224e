// Chi-square of equal bins.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace raygrain::test {

/// How many standard deviations the chi-square statistic of counts that should be equal lies above its mean; normal
/// enough for 50 bins or more with 20 or more each.
inline double chi_square_deviation(const std::vector<size_t>& counts) {
  double total = 0, sum = 0;
  for (const size_t count : counts) total += static_cast<double>(count);
  const double expected = total / static_cast<double>(counts.size());
  for (const size_t count : counts) sum += std::pow(static_cast<double>(count) - expected, 2) / expected;
  const double freedom = static_cast<double>(counts.size()) - 1;
  return (sum - freedom) / std::sqrt(2 * freedom);
}

/// Bin of a value in [0, 1].
inline size_t bin(double value, size_t bins) {
  const double scaled = std::floor(value * static_cast<double>(bins));
  if (scaled < 0) return 0;
  return scaled >= static_cast<double>(bins) ? bins - 1 : static_cast<size_t>(scaled);
}

}  // namespace raygrain::test
