#include "report/scale.h"

#include <algorithm>
#include <cmath>

namespace raygrain {

namespace {

/// The 1, 2 or 5 times a power of ten that is nearest above a sixth of the range.
double round_step(double range) {
  const double rough = range / 6;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= rough) return factor * power;
  return 10 * power;
}

std::vector<double> linear_ticks(double lo, double hi) {
  const double step = round_step(hi - lo);
  std::vector<double> ticks;
  for (double i = std::ceil(lo / step - 1e-9); i * step <= hi * (1 + 1e-9); ++i)
    ticks.push_back(i == 0 ? 0 : i * step);  // not -0
  return ticks;
}

std::vector<double> logarithmic_ticks(double lo, double hi) {
  const bool few = std::log10(hi / lo) < 3;
  std::vector<double> ticks;
  const auto last = static_cast<int>(std::floor(std::log10(hi) + 1e-9));
  for (auto power = static_cast<int>(std::floor(std::log10(lo))); power <= last; ++power)
    for (const double factor : {1.0, 2.0, 5.0})
      if (const double tick = factor * std::pow(10.0, power);
          (factor == 1 || few) && tick >= lo * (1 - 1e-9) && tick <= hi * (1 + 1e-9))
        ticks.push_back(tick);
  return ticks;
}

}  // namespace

double Scale::place(double value) const {
  const double share = logarithmic ? std::log(std::max(value, lo) / lo) / std::log(hi / lo) : (value - lo) / (hi - lo);
  return std::clamp(share, 0.0, 1.0);
}

std::vector<double> Scale::ticks() const {
  return logarithmic ? logarithmic_ticks(lo, hi) : linear_ticks(lo, hi);
}

Scale scale_of(std::span<const double> values, bool logarithmic, bool from_zero) {
  Scale scale{INFINITY, -INFINITY, logarithmic};
  for (const double value : values) {
    if (!std::isfinite(value) || (logarithmic && value <= 0)) continue;
    scale.lo = std::min(scale.lo, value);
    scale.hi = std::max(scale.hi, value);
  }
  if (scale.lo > scale.hi) return {logarithmic ? 1.0 : 0.0, logarithmic ? 10.0 : 1.0, logarithmic};
  if (logarithmic) {
    scale.lo /= 1.25;
    scale.hi *= 1.25;
    return scale;
  }
  if (from_zero) scale.lo = std::min(scale.lo, 0.0);
  const double room = scale.hi > scale.lo ? (scale.hi - scale.lo) * 0.05 : std::max(std::abs(scale.hi), 1.0) * 0.1;
  scale.hi += room;
  if (!from_zero || scale.lo < 0) scale.lo -= room;
  return scale;
}

}  // namespace raygrain
