// The axis of a chart: from values to places, with round numbers along it.
#pragma once

#include <span>
#include <vector>

namespace raygrain {

struct Scale {
  double lo = 0, hi = 1;  // lo < hi, above 0 where logarithmic
  bool logarithmic = false;

  /// 0 at lo, 1 at hi; clamped.
  double place(double value) const;
  /// Some four to ten round numbers in [lo, hi], ascending.
  std::vector<double> ticks() const;
};

/// A scale that holds all finite values with some room; linear ones begin at 0 where `from_zero`. Logarithmic ones
/// leave out what is not above 0.
Scale scale_of(std::span<const double> values, bool logarithmic, bool from_zero);

}  // namespace raygrain
