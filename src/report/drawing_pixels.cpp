#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "report/canvas.h"
#include "report/drawing.h"

namespace raygrain {

namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kWords{{
    {"°", " deg"},
    {"×", "x"},
    {"≤", "<="},
    {"–", "-"},
    {"−", "-"},
    {"…", "..."},
    {"µ", "u"},
}};
constexpr double kAscent = kTextHeight;  // from the baseline to the top of the letters

/// A line with round ends, or a dot where both ends are one: each pixel by its distance, so that edges are smooth.
void paint_capsule(Image& image, const Shape& s, double x1, double y1) {
  const double radius = s.width / 2, reach = radius + 1;
  const auto limit = [](double value, uint32_t size) {
    return static_cast<uint32_t>(std::clamp(value, 0.0, static_cast<double>(size)));
  };
  const uint32_t left = limit(std::min(s.x0, x1) - reach, image.width),
                 top = limit(std::min(s.y0, y1) - reach, image.height);
  const uint32_t right = limit(std::max(s.x0, x1) + reach + 1, image.width),
                 bottom = limit(std::max(s.y0, y1) + reach + 1, image.height);
  const double dx = x1 - s.x0, dy = y1 - s.y0, length2 = dx * dx + dy * dy;
  for (uint32_t y = top; y < bottom; ++y)
    for (uint32_t x = left; x < right; ++x) {
      const double px = x + 0.5 - s.x0, py = y + 0.5 - s.y0;
      const double along = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0;
      const double distance = std::hypot(px - along * dx, py - along * dy);
      const double cover = std::clamp(radius + 0.5 - distance, 0.0, 1.0);
      if (cover <= 0) continue;
      const uint8_t* pixel = &image.rgb[(size_t{y} * image.width + x) * 3];
      set_pixel(image, x, y, mixed({pixel[0], pixel[1], pixel[2]}, s.colour, cover));
    }
}

void paint_box(Image& image, const Shape& s) {
  const auto whole = [](double value) { return static_cast<uint32_t>(std::lround(std::max(value, 0.0))); };
  fill_box(image, {whole(s.x0), whole(s.y0), whole(s.x1) - whole(s.x0), whole(s.y1) - whole(s.y0)}, s.colour);
}

void paint_text(Image& image, const Shape& s) {
  const std::string text = ascii_text(s.text);
  const double width = text_width(text);
  const double shift = s.anchor == Anchor::kStart ? 0 : s.anchor == Anchor::kMiddle ? width / 2 : width;
  draw_text(image, static_cast<uint32_t>(std::max(s.x0 - shift, 0.0)),
            static_cast<uint32_t>(std::max(s.y0 - kAscent, 0.0)), text, s.colour);
}

}  // namespace

std::string ascii_text(const std::string& text) {
  std::string result;
  for (size_t i = 0; i < text.size();) {
    const std::string_view rest = std::string_view(text).substr(i);
    const auto word =
        std::find_if(kWords.begin(), kWords.end(), [&](const auto& w) { return rest.starts_with(w.first); });
    if (word != kWords.end()) {
      result += word->second;
      i += word->first.size();
    } else {
      // The bytes after the first of a UTF-8 letter are part of it.
      if ((static_cast<unsigned char>(text[i]) & 0xc0) != 0x80)
        result += text[i] >= ' ' && text[i] <= '~' ? text[i] : '?';
      ++i;
    }
  }
  return result;
}

Image painted(const Drawing& drawing) {
  Image image =
      blank_image(static_cast<uint32_t>(drawing.width), static_cast<uint32_t>(drawing.height), {255, 255, 255});
  for (const Shape& shape : drawing.shapes) {
    switch (shape.kind) {
      case Shape::Kind::kBox:
        paint_box(image, shape);
        break;
      case Shape::Kind::kLine:
        paint_capsule(image, shape, shape.x1, shape.y1);
        break;
      case Shape::Kind::kDot:
        paint_capsule(image, shape, shape.x0, shape.y0);
        break;
      case Shape::Kind::kText:
        paint_text(image, shape);
        break;
    }
  }
  return image;
}

}  // namespace raygrain
