// The 64 test configurations of "Ray Distribution Aware Heuristics for Bounding Volume Hierarchies Construction in Ray
// Tracing" (2024), section 9.
#pragma once

#include <span>
#include <string_view>

#include "raygrain/area.h"

namespace raygrain {

/// One influence area in one scene. Where the authors' model is not public (Crowd, Sponza) the file is a substitute.
struct PaperExperiment {
  std::string_view scene;    // as the paper names it
  std::string_view source;   // file name, or procedural:KIND
  float scale = 1;           // of the model
  std::string_view variant;  // parallel, 15deg, 45deg, oblique: direction of the rays to the coordinate axes
  std::variant<PlaneArea, PointArea> shape;

  bool is_plane() const { return std::holds_alternative<PlaneArea>(shape); }
};

/// Scene by scene; plane areas first; parallel, 15deg, 45deg, oblique.
std::span<const PaperExperiment> paper_experiments();

}  // namespace raygrain
