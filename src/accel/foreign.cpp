#include "accel/foreign.h"

#include <algorithm>

namespace raygrain {

ForeignFilter::ForeignFilter(std::span<const AreaGeometry> areas) {
  for (const AreaGeometry& area : areas) {
    const double least = 1 - static_cast<double>(area.area().tolerance);
    const auto square = static_cast<float>(std::max(0.0, least * least - 1e-5));
    if (area.is_plane()) {
      axes_.push_back({to_float(area.frame().forward), square});
      continue;
    }
    const Vec3 place = std::get<PointArea>(area.area().shape).eye;
    const auto known = std::ranges::find(eyes_, place, &Eye::place);
    if (known == eyes_.end())
      eyes_.push_back({place, square});
    else
      known->least_square = std::min(known->least_square, square);
  }
}

}  // namespace raygrain
