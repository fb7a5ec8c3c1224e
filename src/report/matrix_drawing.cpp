// Values as numbers in a grid: blue where less than the reference is paid, orange where more.
#include <algorithm>
#include <cmath>

#include "report/canvas.h"
#include "report/charts.h"
#include "report/panel_drawing.h"

namespace raygrain {

namespace {

constexpr double kRow = 30, kTop = 100;
constexpr Colour kLess{43, 123, 186}, kMore{217, 72, 15};

Shape text(double x, double y, const std::string& what, Colour colour, Anchor anchor) {
  return {.kind = Shape::Kind::kText, .x0 = x, .y0 = y, .colour = colour, .text = what, .anchor = anchor};
}

/// Full colour at half or twice the reference.
Colour cell_colour(double value, double reference) {
  const double doublings = value > 0 && reference > 0 ? std::log2(value / reference) : 0;
  return mixed(kWhite, doublings < 0 ? kLess : kMore, 0.75 * std::min(std::abs(doublings), 1.0));
}

}  // namespace

std::string description(const ChartPoint& point, bool published) {
  std::string text = point.series;
  if (!point.group.empty()) text += ", " + point.group;
  if (!point.label.empty()) text += ", " + point.label;
  if (!std::isnan(point.x)) text += ", at " + short_number(point.x);
  text += (published ? ", published: " : ": ") + short_number(point.y);
  if (point.count > 1)
    text += " (mean of " + std::to_string(point.count) + ", from " + short_number(point.low) + " to " +
            short_number(point.high) + ")";
  return text;
}

Drawing matrix_drawing(const ChartPanel& panel) {
  double widest = 0;
  for (const ChartSeries& series : panel.series)
    widest = std::max(widest, double{1} * text_width(ascii_text(series.name)));
  const double left = kPanelMargin + std::min(widest, kMostLabelWidth) + 16;
  const double column = (kPanelWidth - kPanelMargin - left) / std::max(1.0, static_cast<double>(panel.groups.size()));
  const auto room = static_cast<uint32_t>(std::max(column - 8, 1.0));

  Drawing drawing{kPanelWidth, kTop + kRow * static_cast<double>(panel.series.size()) + 44, {}};
  drawing.shapes.push_back(text(kPanelMargin, 32, panel.title, kInk, Anchor::kStart));
  drawing.shapes.push_back(text(kPanelMargin, drawing.height - 14, panel.y.title, kSoft, Anchor::kStart));
  for (size_t g = 0; g < panel.groups.size(); ++g) {
    // Two words stand below each other.
    const std::string& group = panel.groups[g];
    const double middle = left + (static_cast<double>(g) + 0.5) * column;
    const size_t gap = text_width(ascii_text(group)) > room ? group.find(' ') : std::string::npos;
    drawing.shapes.push_back(
        text(middle, kTop - 30, shortened_to(ascii_text(group.substr(0, gap)), room), kInk, Anchor::kMiddle));
    if (gap != std::string::npos)
      drawing.shapes.push_back(
          text(middle, kTop - 10, shortened_to(ascii_text(group.substr(gap + 1)), room), kInk, Anchor::kMiddle));
  }
  for (size_t s = 0; s < panel.series.size(); ++s) {
    const std::string& series = panel.series[s].name;
    const double top = kTop + static_cast<double>(s) * kRow;
    drawing.shapes.push_back(text(left - 12, top + 21,
                                  shortened_to(ascii_text(series), static_cast<uint32_t>(kMostLabelWidth)), kInk,
                                  Anchor::kEnd));
    for (const ChartPoint& point : panel.measured) {
      const auto group = std::find(panel.groups.begin(), panel.groups.end(), point.group);
      if (point.series != series || group == panel.groups.end() || !std::isfinite(point.y)) continue;
      const double x = left + static_cast<double>(group - panel.groups.begin()) * column;
      drawing.shapes.push_back({.x0 = x + 1,
                                .y0 = top + 1,
                                .x1 = x + column - 1,
                                .y1 = top + kRow - 1,
                                .colour = cell_colour(point.y, panel.reference),
                                .text = description(point, false)});
      drawing.shapes.push_back(text(x + column / 2, top + 21, short_number(point.y), kInk, Anchor::kMiddle));
    }
  }
  return drawing;
}

}  // namespace raygrain
