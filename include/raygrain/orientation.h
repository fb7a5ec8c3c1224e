// Split orientations: which axes to cut a node across, best first.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "raygrain/bounds.h"

namespace raygrain {

/// What a strategy may know of a node: never rays, areas or meshes.
struct NodeContext {
  Bounds bounds;
  uint32_t count = 0;    // primitives
  uint32_t level = 0;    // root = 0
  int parent_axis = -1;  // axis that made this node, -1 for the root
  uint64_t seed = 0;     // the same for the same node and BuildOptions::seed: for randomised strategies
};

struct AxisChoice {
  int axis = 0;       // 0, 1, 2
  float quality = 1;  // in [0, 1], higher is better
};

/// Up to three axes, best first.
struct AxisOrder {
  std::array<AxisChoice, 3> choices{};
  int count = 0;

  void push(AxisChoice choice) { choices[static_cast<size_t>(count++)] = choice; }
};

using SplitOrientation = std::function<AxisOrder(const NodeContext&)>;

/// All three axes at quality 1, in the order x, y, z: "+ALL". The default of the builders.
SplitOrientation all_axes_orientation();

/// Sorts by quality, best first; equal qualities keep the order x, y, z. `qualities` is per axis.
AxisOrder sorted_axes(Vec3 qualities);

}  // namespace raygrain
