// One triangle as the light sees it: its outline, its plane, and the part of the window that it may touch.
#pragma once

#include <array>
#include <optional>

#include "trace/coverage_grid.h"

namespace raygrain {

/// In double precision. Edge i runs from corner i to corner i + 1.
struct SeenTriangle {
  CoverageTriangle record;
  double margin = 0;                                // of the place of columns against it
  double x_lo, x_hi, y_lo, y_hi;                    // of its part in the window, without margins
  double s_lo, s_hi;                                // its depths there, margins included
  std::array<std::array<double, 3>, 3> edges;       // a, b, c: unit normals where is_clear
  std::array<std::array<double, 4>, 3> edge_boxes;  // x_lo, x_hi, y_lo, y_hi of each edge
  double slope_x = 0, slope_y = 0, offset = 0;  // s = slope_x x + slope_y y + offset +- plane_error, where has_plane
  double plane_error = 0;
  bool is_clear = false;  // neither a line nor a point to the light, up to margins: `edges` tell in from out
  bool has_plane = false;

  /// May a column within `half` of (x, y), in both coordinates, or within margins of that, meet it? By its edges.
  bool may_touch(double x, double y, double half) const;
};

enum class Seen {
  kNothing,  // no part of it in the window
  kNear,     // too near to the eye to be seen as columns see things
  kSeen,
};

/// Only where it is: sets its place, its depths without margins, and `margin`. `near_z` counts for eyes.
Seen place_in_window(const CoverageGrid& grid, double near_z, uint32_t id, SeenTriangle& seen);
Seen look_at(const CoverageGrid& grid, double near_z, uint32_t id, SeenTriangle& seen);

}  // namespace raygrain
