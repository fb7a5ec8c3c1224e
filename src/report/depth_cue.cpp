#include "report/depth_cue.h"

#include <algorithm>
#include <cmath>

namespace raygrain {

namespace {

struct Range {
  float lo = 0, hi = 0;
};

/// The finite distances without the outermost 2 % at either end.
Range typical_range(std::span<const float> distances) {
  std::vector<float> finite;
  for (const float d : distances)
    if (std::isfinite(d)) finite.push_back(d);
  if (finite.empty()) return {};
  const auto at = [&](size_t index) {
    std::nth_element(finite.begin(), finite.begin() + static_cast<std::ptrdiff_t>(index), finite.end());
    return finite[index];
  };
  return {at(finite.size() / 50), at(finite.size() - 1 - finite.size() / 50)};
}

/// Mean of the window of 2 radius + 1 values around each, along one line of `count` values `step` apart. Values beyond
/// the ends repeat the end's.
void blur_line(float* values, size_t count, size_t step, size_t radius, std::vector<float>& copy) {
  copy.resize(count);
  for (size_t i = 0; i < count; ++i) copy[i] = values[i * step];
  const auto clamped = [&](std::ptrdiff_t i) {
    return static_cast<double>(
        copy[static_cast<size_t>(std::clamp<std::ptrdiff_t>(i, 0, static_cast<std::ptrdiff_t>(count) - 1))]);
  };
  const auto reach = static_cast<std::ptrdiff_t>(radius);
  double sum = 0;
  for (std::ptrdiff_t i = -reach; i <= reach; ++i) sum += clamped(i);
  for (size_t i = 0; i < count; ++i) {
    values[i * step] = static_cast<float>(sum / static_cast<double>(2 * radius + 1));
    const auto middle = static_cast<std::ptrdiff_t>(i);
    sum += clamped(middle + reach + 1) - clamped(middle - reach);
  }
}

/// Two box filters in each direction: close to a Gaussian.
void blur(std::vector<float>& values, size_t width, size_t height, size_t radius) {
  std::vector<float> copy;
  for (int pass = 0; pass < 2; ++pass) {
    for (size_t y = 0; y < height; ++y) blur_line(&values[y * width], width, 1, radius, copy);
    for (size_t x = 0; x < width; ++x) blur_line(&values[x], height, width, radius, copy);
  }
}

}  // namespace

DepthCues depth_cues(std::span<const float> distances, uint32_t width, uint32_t height) {
  const Range range = typical_range(distances);
  const float span = std::max(range.hi - range.lo, 1e-6f * std::max(std::abs(range.hi), 1e-30f));
  DepthCues cues;
  cues.far_share.reserve(distances.size());
  for (const float d : distances) cues.far_share.push_back(std::clamp((d - range.lo) / span, 0.0f, 1.0f));
  cues.behind = cues.far_share;
  blur(cues.behind, width, height, std::max<size_t>(2, std::max(width, height) / 80));
  for (size_t i = 0; i < cues.behind.size(); ++i)
    cues.behind[i] = std::clamp(2.5f * (cues.far_share[i] - cues.behind[i]), 0.0f, 1.0f);
  return cues;
}

}  // namespace raygrain
