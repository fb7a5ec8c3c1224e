#include "report/canvas.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include <stb/stb_easy_font.h>

namespace raygrain {

namespace {

constexpr uint32_t kTextScale = 2;                   // pixels per pixel of the font
constexpr size_t kBytesPerLetter = size_t{16} * 64;  // more than any letter has strokes

std::string printable(std::string text) {
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return text;
}

}  // namespace

Image blank_image(uint32_t width, uint32_t height, Colour colour) {
  Image image{width, height, std::vector<uint8_t>(size_t{width} * height * 3)};
  fill_box(image, {0, 0, width, height}, colour);
  return image;
}

void set_pixel(Image& image, uint32_t x, uint32_t y, Colour colour) {
  uint8_t* pixel = &image.rgb[(size_t{y} * image.width + x) * 3];
  pixel[0] = colour.red;
  pixel[1] = colour.green;
  pixel[2] = colour.blue;
}

void fill_box(Image& image, const PixelBox& box, Colour colour) {
  const uint32_t right = std::min(image.width, box.x + box.width), bottom = std::min(image.height, box.y + box.height);
  for (uint32_t y = box.y; y < bottom; ++y)
    for (uint32_t x = box.x; x < right; ++x) set_pixel(image, x, y, colour);
}

void draw_image(Image& target, const Image& source, uint32_t x, uint32_t y) {
  if (x >= target.width) return;
  const size_t row_bytes = size_t{std::min(source.width, target.width - x)} * 3;
  for (uint32_t row = 0; row < source.height && y + row < target.height; ++row)
    std::copy_n(&source.rgb[size_t{row} * source.width * 3], row_bytes,
                &target.rgb[(size_t{y + row} * target.width + x) * 3]);
}

uint32_t text_width(const std::string& text) {
  std::string letters = printable(text);
  return static_cast<uint32_t>(stb_easy_font_width(letters.data())) * kTextScale;
}

void draw_text(Image& image, uint32_t x, uint32_t y, const std::string& text, Colour colour) {
  std::string letters = printable(text);
  std::vector<char> buffer(letters.size() * kBytesPerLetter + 64);
  const int quads = stb_easy_font_print(0, 0, letters.data(), nullptr, buffer.data(), static_cast<int>(buffer.size()));
  // Each quad is four corners of (x, y, z, colour), 16 bytes a corner; the first and third are opposite.
  for (int i = 0; i < quads; ++i) {
    float first[2], third[2];
    std::memcpy(first, &buffer[static_cast<size_t>(i) * 64], sizeof first);
    std::memcpy(third, &buffer[static_cast<size_t>(i) * 64 + 32], sizeof third);
    fill_box(image,
             {x + static_cast<uint32_t>(first[0]) * kTextScale, y + static_cast<uint32_t>(first[1]) * kTextScale,
              static_cast<uint32_t>(third[0] - first[0]) * kTextScale,
              static_cast<uint32_t>(third[1] - first[1]) * kTextScale},
             colour);
  }
}

std::string shortened_to(const std::string& text, uint32_t width) {
  if (text_width(text) <= width) return text;
  std::string start = text;
  while (!start.empty() && text_width(start + "...") > width) start.pop_back();
  return start + "...";
}

}  // namespace raygrain
