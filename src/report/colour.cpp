#include "report/colour.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace raygrain {

namespace {

// CIE lightness of these rises by about 12 from each to the next.
constexpr std::array<Colour, 9> kHeatPoints{{{8, 6, 24},
                                             {37, 14, 82},
                                             {84, 18, 110},
                                             {131, 34, 108},
                                             {180, 52, 88},
                                             {219, 82, 58},
                                             {244, 126, 32},
                                             {250, 182, 50},
                                             {251, 243, 160}}};

uint8_t mixed_channel(uint8_t a, uint8_t b, double share) {
  return static_cast<uint8_t>(std::lround(a + (static_cast<double>(b) - a) * share));
}

}  // namespace

Colour mixed(Colour a, Colour b, double share) {
  share = std::clamp(share, 0.0, 1.0);
  return {mixed_channel(a.red, b.red, share), mixed_channel(a.green, b.green, share),
          mixed_channel(a.blue, b.blue, share)};
}

Colour heat_colour(double value) {
  const double position = std::clamp(value, 0.0, 1.0) * (kHeatPoints.size() - 1);
  const size_t below = std::min(static_cast<size_t>(position), kHeatPoints.size() - 2);
  return mixed(kHeatPoints[below], kHeatPoints[below + 1], position - static_cast<double>(below));
}

}  // namespace raygrain
