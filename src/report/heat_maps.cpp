#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "raygrain/report.h"

#include "report/canvas.h"

namespace raygrain {

namespace {

constexpr Colour kPaper{250, 250, 248}, kInk{28, 30, 36}, kSoftInk{96, 100, 110}, kFrame{120, 124, 132};
constexpr uint32_t kMargin = 24, kGap = 20, kBarWidth = 22, kLabelWidth = 116, kTick = 6;
constexpr uint32_t kSmallestWidth = 200;  // of a map's column, so that its texts fit

using NamedMap = std::pair<std::string, CostImage>;

/// The end of the common scale: the 99th percentile of all pixels that cost anything, so that few extreme ones do not
/// darken the rest.
double scale_end(std::span<const NamedMap> maps) {
  std::vector<float> costs;
  for (const auto& [name, map] : maps)
    for (const float cost : map.cost)
      if (cost > 0) costs.push_back(cost);
  if (costs.empty()) return 1;
  const auto at = costs.begin() + static_cast<std::ptrdiff_t>((costs.size() - 1) * 99 / 100);
  std::nth_element(costs.begin(), at, costs.end());
  return *at;
}

/// 1, 2 or 5 times a power of ten, so that the scale has four to ten steps.
double tick_step(double end) {
  double step = 1e-6;
  while (step * 10 < end) step *= 10;
  while (true) {
    for (const double factor : {0.1, 0.2, 0.5, 1.0, 2.0, 5.0})
      if (end / (step * factor) <= 8) return step * factor;
    step *= 10;
  }
}

Image coloured(const CostImage& map, double end) {
  Image image = blank_image(map.width, map.height, kInk);
  for (uint32_t y = 0; y < map.height; ++y)
    for (uint32_t x = 0; x < map.width; ++x)
      set_pixel(image, x, y, heat_colour(static_cast<double>(map.cost[size_t{y} * map.width + x]) / end));
  return image;
}

std::string summary(const CostImage& map) {
  double sum = 0;
  float highest = 0;
  for (const float cost : map.cost) {
    sum += static_cast<double>(cost);
    highest = std::max(highest, cost);
  }
  const double pixels = std::max<double>(1, static_cast<double>(map.cost.size()));
  return fmt::format("mean {:.1f}  highest {:.0f}", sum / pixels, highest);
}

void draw_framed(Image& page, const Image& picture, uint32_t x, uint32_t y) {
  fill_box(page, {x - 1, y - 1, picture.width + 2, picture.height + 2}, kFrame);
  draw_image(page, picture, x, y);
}

void draw_colour_bar(Image& page, const PixelBox& box, double end) {
  fill_box(page, {box.x - 1, box.y - 1, box.width + 2, box.height + 2}, kFrame);
  for (uint32_t row = 0; row < box.height; ++row)
    fill_box(page, {box.x, box.y + row, box.width, 1}, heat_colour(1 - (row + 0.5) / box.height));
  const double step = tick_step(end);
  const uint32_t text_x = box.x + box.width + kTick + 4;
  for (int i = 0; i * step <= end * (1 + 1e-9); ++i) {
    const double value = i * step;
    const auto down = static_cast<uint32_t>(std::lround((1 - std::min(value / end, 1.0)) * (box.height - 1)));
    fill_box(page, {box.x + box.width + 1, box.y + down, kTick, 1}, kInk);
    const uint32_t half_text = kTextHeight / 2;
    draw_text(page, text_x, box.y + down - std::min(half_text, box.y + down), fmt::format("{:g}", value), kInk);
  }
}

}  // namespace

Image heat_maps(std::span<const NamedMap> maps) {
  const double end = scale_end(maps);
  uint32_t height = 0, width = kMargin;
  for (const auto& [name, map] : maps) {
    height = std::max(height, map.height);
    width += std::max(map.width, kSmallestWidth) + kGap;
  }
  const uint32_t top = kMargin + kLineHeight;
  Image page = blank_image(width + kBarWidth + kLabelWidth + kMargin, top + height + kLineHeight + kMargin, kPaper);

  uint32_t x = kMargin;
  for (const auto& [name, map] : maps) {
    const uint32_t column = std::max(map.width, kSmallestWidth);
    draw_text(page, x, kMargin, shortened_to(name, column), kInk);
    draw_framed(page, coloured(map, end), x, top);
    draw_text(page, x, top + map.height + kLineHeight - kTextHeight, shortened_to(summary(map), column), kSoftInk);
    x += column + kGap;
  }
  draw_text(page, x, kMargin, "cost per ray", kInk);
  draw_colour_bar(page, {x, top, kBarWidth, height}, end);
  return page;
}

Image captioned(const Image& picture, const std::string& title, const std::string& caption) {
  const uint32_t column = std::max(picture.width, kSmallestWidth), top = kMargin + kLineHeight;
  Image page = blank_image(column + 2 * kMargin, top + picture.height + kLineHeight + kMargin, kPaper);
  draw_text(page, kMargin, kMargin, shortened_to(title, column), kInk);
  draw_framed(page, picture, kMargin, top);
  draw_text(page, kMargin, top + picture.height + kLineHeight - kTextHeight, shortened_to(caption, column), kSoftInk);
  return page;
}

}  // namespace raygrain
