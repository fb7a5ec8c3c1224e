#include "raygrain/orientation.h"

#include <utility>

namespace raygrain {

SplitOrientation all_axes_orientation() {
  return [](const NodeContext&) { return AxisOrder{{AxisChoice{0, 1}, AxisChoice{1, 1}, AxisChoice{2, 1}}, 3}; };
}

AxisOrder sorted_axes(Vec3 qualities) {
  AxisOrder order{{AxisChoice{0, qualities.x}, AxisChoice{1, qualities.y}, AxisChoice{2, qualities.z}}, 3};
  // Bubble sort of three: stable, so equal qualities keep the order x, y, z.
  const auto order_pair = [&order](size_t i) {
    if (order.choices[i].quality < order.choices[i + 1].quality) std::swap(order.choices[i], order.choices[i + 1]);
  };
  order_pair(0);
  order_pair(1);
  order_pair(0);
  return order;
}

}  // namespace raygrain
