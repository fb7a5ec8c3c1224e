// Charts as shapes: a title, the name of the axis of values, a legend, the axes, and the marks of each kind of panel.
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "raygrain/chart.h"

#include "report/canvas.h"
#include "report/charts.h"
#include "report/drawing.h"
#include "report/panel_drawing.h"
#include "report/scale.h"

namespace raygrain {

namespace {

constexpr double kUprightHeight = 360, kRightMargin = 32;
constexpr double kDotRow = 30, kBarWidth = 12, kDot = 9;
constexpr Colour kRule{222, 226, 230};

Colour parsed(const std::string& hex) {
  const auto part = [&](size_t i) {
    return static_cast<uint8_t>(hex.size() == 7 ? std::stoi(hex.substr(i, 2), nullptr, 16) : 128);
  };
  return {part(1), part(3), part(5)};
}

bool lies_down(const ChartPanel& panel) {
  return panel.kind == ChartKind::kRanking || panel.kind == ChartKind::kDots;
}

bool has_number_axis(const ChartPanel& panel) {
  return panel.kind == ChartKind::kPoints || panel.kind == ChartKind::kLines;
}

std::string tick_text(double value) {
  return fmt::format("{:.10g}", value);
}

class PanelDrawing {
 public:
  explicit PanelDrawing(const ChartPanel& panel) : panel_(panel) {
    drawing_.width = kPanelWidth;
    std::vector<double> values{panel.reference}, numbers;
    for (const std::vector<ChartPoint>* points : {&panel.measured, &panel.published})
      for (const ChartPoint& point : *points) {
        values.push_back(point.y);
        numbers.push_back(point.x);
      }
    const bool bars = panel.kind == ChartKind::kBars || panel.kind == ChartKind::kRanking;
    values_ = scale_of(values, panel.y.logarithmic, bars);
    numbers_ = scale_of(numbers, panel.x.logarithmic, false);
    for (size_t i = 0; i < panel.series.size(); ++i) series_[panel.series[i].name] = i;
    for (size_t i = 0; i < panel.groups.size(); ++i) groups_[panel.groups[i]] = i;
  }

  Drawing draw() {
    head();
    frame();
    for (const ChartPoint& point : panel_.measured) mark(point);
    if (panel_.kind == ChartKind::kLines) join();
    if (!std::isnan(panel_.reference)) across(panel_.reference, kInk, 1);
    for (const ChartPoint& point : panel_.published) published_mark(point);
    return std::move(drawing_);
  }

 private:
  void text(double x, double y, const std::string& what, Colour colour, Anchor anchor = Anchor::kStart) {
    drawing_.shapes.push_back(
        {.kind = Shape::Kind::kText, .x0 = x, .y0 = y, .colour = colour, .text = what, .anchor = anchor});
  }
  void box(double x0, double y0, double x1, double y1, Colour colour, std::string title = {}) {
    drawing_.shapes.push_back({.x0 = x0, .y0 = y0, .x1 = x1, .y1 = y1, .colour = colour, .text = std::move(title)});
  }
  void line(double x0, double y0, double x1, double y1, Colour colour, double width, std::string title = {}) {
    drawing_.shapes.push_back({.kind = Shape::Kind::kLine,
                               .x0 = x0,
                               .y0 = y0,
                               .x1 = x1,
                               .y1 = y1,
                               .width = width,
                               .colour = colour,
                               .text = std::move(title)});
  }
  void dot(double x, double y, double size, Colour colour, std::string title = {}) {
    drawing_.shapes.push_back(
        {.kind = Shape::Kind::kDot, .x0 = x, .y0 = y, .width = size, .colour = colour, .text = std::move(title)});
  }

  /// Title, legend, and the name of the axis of values.
  void head() {
    text(kPanelMargin, 32, panel_.title, kInk);
    double x = kPanelMargin, y = 64;
    const auto entry = [&](const std::string& name, bool published, Colour colour) {
      const double width = 44 + text_width(ascii_text(name));
      if (x + width > kPanelWidth - kPanelMargin && x > kPanelMargin) {
        x = kPanelMargin;
        y += 26;
      }
      if (published)
        line(x, y - 6, x + 13, y - 6, kInk, 3);
      else
        box(x, y - 13, x + 14, y + 1, colour);
      text(x + 22, y, name, kSoft);
      x += width;
    };
    for (const ChartSeries& series : panel_.series) entry(series.name, false, parsed(series.colour));
    if (!panel_.published.empty()) entry("published", true, kInk);
    top_ = y + 16;
    if (!lies_down(panel_)) {
      text(kPanelMargin, top_ + 16, panel_.y.title, kSoft);
      top_ += 34;
    }
  }

  void frame() {
    left_ = kPanelMargin + 64;
    right_ = kPanelWidth - kRightMargin;
    if (lies_down(panel_)) {
      double widest = 0;
      for (const std::string& group : panel_.groups)
        widest = std::max(widest, double{1} * text_width(ascii_text(group)));
      left_ = kPanelMargin + std::min(widest, kMostLabelWidth) + 16;
      bottom_ = top_ + row_height() * static_cast<double>(panel_.groups.size());
      drawing_.height = std::floor(bottom_ + 64);
      text((left_ + right_) / 2, bottom_ + 50, panel_.y.title, kSoft, Anchor::kMiddle);
    } else {
      bottom_ = top_ + kUprightHeight;
      drawing_.height = std::floor(bottom_ + 76);
      if (!panel_.x.title.empty()) text((left_ + right_) / 2, bottom_ + 62, panel_.x.title, kSoft, Anchor::kMiddle);
    }
    for (const double tick : values_.ticks()) {
      across(tick, kRule, 1);
      if (lies_down(panel_))
        text(along(tick), bottom_ + 24, tick_text(tick), kSoft, Anchor::kMiddle);
      else
        text(left_ - 8, along(tick) + 6, tick_text(tick), kSoft, Anchor::kEnd);
    }
    if (has_number_axis(panel_))
      for (const double tick : numbers_.ticks())
        text(number_place(tick), bottom_ + 26, tick_text(tick), kSoft, Anchor::kMiddle);
    else
      for (const std::string& group : panel_.groups) group_name(group);
  }

  void group_name(const std::string& group) {
    if (lies_down(panel_)) {
      text(left_ - 12, group_place(group) + 6, shortened_to(ascii_text(group), static_cast<uint32_t>(kMostLabelWidth)),
           kInk, Anchor::kEnd);
      return;
    }
    // Two words stand below each other.
    const auto room = static_cast<uint32_t>(band() - 4);
    const size_t gap = text_width(ascii_text(group)) > room ? group.find(' ') : std::string::npos;
    text(group_place(group), bottom_ + 24, shortened_to(ascii_text(group.substr(0, gap)), room), kInk, Anchor::kMiddle);
    if (gap != std::string::npos)
      text(group_place(group), bottom_ + 44, shortened_to(ascii_text(group.substr(gap + 1)), room), kInk,
           Anchor::kMiddle);
  }

  double row_height() const {
    return panel_.kind == ChartKind::kDots ? kDotRow : kBarWidth * static_cast<double>(panel_.series.size()) + 14;
  }
  double band() const {
    const double length = lies_down(panel_) ? bottom_ - top_ : right_ - left_;
    return length / std::max(1.0, static_cast<double>(panel_.groups.size()));
  }
  /// Where a value lies along the axis of values.
  double along(double value) const {
    const double share = values_.place(value);
    return lies_down(panel_) ? left_ + share * (right_ - left_) : bottom_ - share * (bottom_ - top_);
  }
  double number_place(double x) const { return left_ + numbers_.place(x) * (right_ - left_); }
  double group_place(const std::string& group) const {
    const double start = lies_down(panel_) ? top_ : left_;
    return start + (static_cast<double>(groups_.at(group)) + 0.5) * band();
  }
  double bar_width() const {
    return lies_down(panel_) ? kBarWidth : band() * 0.8 / std::max(1.0, static_cast<double>(panel_.series.size()));
  }
  /// The middle of a bar across the axis of values.
  double bar_place(const ChartPoint& point) const {
    const double first = group_place(point.group) - bar_width() * static_cast<double>(panel_.series.size()) / 2;
    return first + (static_cast<double>(series_.at(point.series)) + 0.5) * bar_width();
  }
  bool is_known(const ChartPoint& point) const {
    return std::isfinite(point.y) && series_.contains(point.series) &&
           (has_number_axis(panel_) || groups_.contains(point.group));
  }

  /// A line across the whole chart at a value.
  void across(double value, Colour colour, double width) {
    if (lies_down(panel_))
      line(along(value), top_, along(value), bottom_, colour, width);
    else
      line(left_, along(value), right_, along(value), colour, width);
  }

  void mark(const ChartPoint& point) {
    if (!is_known(point)) return;
    const Colour colour = parsed(panel_.series[series_.at(point.series)].colour);
    const std::string title = description(point, false);
    const double value = along(point.y), zero = along(panel_.y.logarithmic ? values_.lo : 0);
    switch (panel_.kind) {
      case ChartKind::kBars: {
        const double middle = bar_place(point), half = bar_width() / 2 - 1;
        return box(middle - half, std::min(value, zero), middle + half, std::max(value, zero), colour, title);
      }
      case ChartKind::kRanking: {
        const double middle = bar_place(point), half = bar_width() / 2 - 1;
        return box(std::min(value, zero), middle - half, std::max(value, zero), middle + half, colour, title);
      }
      case ChartKind::kDots:
        return dot(value, group_place(point.group), kDot, colour, title);
      case ChartKind::kMatrix:
      case ChartKind::kPoints:
      case ChartKind::kLines:
        if (std::isfinite(point.x)) dot(number_place(point.x), value, kDot, colour, title);
        return;
    }
  }

  void join() {
    for (const ChartSeries& series : panel_.series) {
      std::vector<const ChartPoint*> points;
      for (const ChartPoint& point : panel_.measured)
        if (point.series == series.name && is_known(point) && std::isfinite(point.x)) points.push_back(&point);
      std::stable_sort(points.begin(), points.end(), [](const auto* a, const auto* b) { return a->x < b->x; });
      for (size_t i = 1; i < points.size(); ++i)
        line(number_place(points[i - 1]->x), along(points[i - 1]->y), number_place(points[i]->x), along(points[i]->y),
             parsed(series.colour), 2);
    }
  }

  /// A dark line across the bar, or a ring around the dot, with a white edge to be seen on any colour.
  void published_mark(const ChartPoint& point) {
    if (!is_known(point)) return;
    const std::string title = description(point, true);
    const double value = along(point.y);
    if (has_number_axis(panel_)) {
      dot(number_place(point.x), value, kDot + 4, kInk, title);
      return dot(number_place(point.x), value, kDot - 1, kWhite, title);
    }
    const bool dots = panel_.kind == ChartKind::kDots;
    const double middle = dots ? group_place(point.group) : bar_place(point), half = dots ? 10 : bar_width() / 2 + 1;
    for (const auto& [width, colour] : {std::pair{6.0, kWhite}, std::pair{3.0, kInk}}) {
      if (lies_down(panel_))
        line(value, middle - half, value, middle + half, colour, width, title);
      else
        line(middle - half, value, middle + half, value, colour, width, title);
    }
  }

  const ChartPanel& panel_;
  Drawing drawing_;
  Scale values_, numbers_;
  std::map<std::string, size_t> series_, groups_;
  double top_ = 0, bottom_ = 0, left_ = 0, right_ = 0;
};

}  // namespace

Drawing panel_drawing(const ChartPanel& panel) {
  return panel.kind == ChartKind::kMatrix ? matrix_drawing(panel) : PanelDrawing(panel).draw();
}

std::string chart_svg(const ChartPanel& panel) {
  return svg_text(panel_drawing(panel));
}

Image chart_image(const ChartPanel& panel) {
  return painted(panel_drawing(panel));
}

}  // namespace raygrain
