// A picture as a list of shapes, written as SVG or painted as pixels.
#pragma once

#include <string>
#include <vector>

#include "raygrain/io.h"

#include "report/colour.h"

namespace raygrain {

enum class Anchor { kStart, kMiddle, kEnd };

/// Lengths in pixels from the top left.
struct Shape {
  enum class Kind { kBox, kLine, kDot, kText };
  Kind kind = Kind::kBox;
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // corners, ends; the centre of a dot, the baseline's anchor of a text
  double width = 1;                       // of a line; a dot's diameter
  Colour colour{};
  std::string text{};  // of a text; of other shapes what is said about them when they are pointed at
  Anchor anchor = Anchor::kStart;
};

struct Drawing {
  double width = 0, height = 0;
  std::vector<Shape> shapes{};
};

std::string svg_text(const Drawing& drawing);
Image painted(const Drawing& drawing);

/// UTF-8 as printable ASCII: degree signs and the like become words, the rest '?'.
std::string ascii_text(const std::string& text);

/// For HTML and SVG. Bytes that are no UTF-8 and control characters are replaced.
std::string escaped(const std::string& text);

}  // namespace raygrain
