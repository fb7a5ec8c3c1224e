// Drawing on images: boxes, other images, and text in a small bitmap font.
#pragma once

#include <cstdint>
#include <string>

#include "raygrain/io.h"

#include "report/colour.h"

namespace raygrain {

/// Position and size in pixels from the top left.
struct PixelBox {
  uint32_t x = 0, y = 0, width = 0, height = 0;
};

Image blank_image(uint32_t width, uint32_t height, Colour colour);
void set_pixel(Image& image, uint32_t x, uint32_t y, Colour colour);

/// Parts outside the image are left out, here and below.
void fill_box(Image& image, const PixelBox& box, Colour colour);
void draw_image(Image& target, const Image& source, uint32_t x, uint32_t y);

/// Height of a line of text, and the distance from one line to the next, in pixels.
inline constexpr uint32_t kTextHeight = 14, kLineHeight = 22;

uint32_t text_width(const std::string& text);
/// One line of printable ASCII (anything else becomes '?') with its top left corner at (x, y).
void draw_text(Image& image, uint32_t x, uint32_t y, const std::string& text, Colour colour);

/// The text, or its beginning with "..." where it would be wider than `width` pixels.
std::string shortened_to(const std::string& text, uint32_t width);

}  // namespace raygrain
