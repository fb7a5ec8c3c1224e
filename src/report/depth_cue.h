// What makes a flat picture look deep: a share of distance, and darkness behind edges.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace raygrain {

/// Per sample, in [0, 1].
struct DepthCues {
  std::vector<float>
      far_share;              // 0 at the nearest distances, 1 at the farthest (2 % of the samples aside), 1 for misses
  std::vector<float> behind;  // how much farther than its surroundings
};

/// `distances` row by row, infinite for misses. "Behind" is the depth buffer minus its blurred self, after Luft,
/// Colditz and Deussen, "Image enhancement by unsharp masking the depth buffer" (2006).
DepthCues depth_cues(std::span<const float> distances, uint32_t width, uint32_t height);

}  // namespace raygrain
