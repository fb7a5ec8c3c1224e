// Colours of pictures, and the scale from numbers to colours.
#pragma once

#include <cstdint>

namespace raygrain {

/// sRGB, 8 bits a channel.
struct Colour {
  uint8_t red = 0, green = 0, blue = 0;

  friend constexpr bool operator==(const Colour&, const Colour&) = default;
};

/// Linear mix of the encoded values; `share` of `b`, clamped to [0, 1].
Colour mixed(Colour a, Colour b, double share);

/// The colour of a value in [0, 1] (clamped): from near black through violet, red and orange to pale yellow. Its
/// lightness rises steadily, so it reads the same without colour vision and in grey print.
Colour heat_colour(double value);

}  // namespace raygrain
