// Panels as shapes: what the drawings of all kinds share.
#pragma once

#include <string>

#include "raygrain/chart.h"

#include "report/drawing.h"

namespace raygrain {

inline constexpr double kPanelWidth = 1200, kPanelMargin = 24, kMostLabelWidth = 420;
inline constexpr Colour kInk{33, 37, 41}, kSoft{95, 103, 112}, kWhite{255, 255, 255};

/// Any panel.
Drawing panel_drawing(const ChartPanel& panel);
/// A panel of kind kMatrix.
Drawing matrix_drawing(const ChartPanel& panel);

/// What is said of a point when a reader points at it.
std::string description(const ChartPoint& point, bool published);

}  // namespace raygrain
