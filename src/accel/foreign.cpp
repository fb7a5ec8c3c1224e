#include "accel/foreign.h"

#include <algorithm>
#include <cmath>

namespace raygrain {
namespace {

float greatest_square(const InfluenceArea& area, Reach reach) {
  const double least = std::max(0.0, 1 - static_cast<double>(area.tolerance));
  const double tolerated = reach == Reach::kTolerance ? 1 - least * least : 0;
  // A cross product of floats is wrong by a few roundings of the factors: a sine by less than 2^-20.
  const double sine = std::sqrt(tolerated) + kAxisSine;
  return static_cast<float>(sine * sine * (1 + 0x1p-18));
}

}  // namespace

ForeignFilter::ForeignFilter(std::span<const AreaGeometry> areas, std::span<const Reach> reaches) {
  for (size_t i = 0; i < areas.size(); ++i) {
    if (reaches[i] == Reach::kNone) continue;
    const float square = greatest_square(areas[i].area(), reaches[i]);
    if (areas[i].is_plane()) {
      axes_.push_back({to_float(areas[i].frame().forward), square});
      continue;
    }
    const Vec3 place = std::get<PointArea>(areas[i].area().shape).eye;
    const auto known = std::ranges::find(eyes_, place, &Eye::place);
    if (known == eyes_.end())
      eyes_.push_back({place, square});
    else
      known->greatest_square = std::max(known->greatest_square, square);
  }
}

}  // namespace raygrain
