#include <algorithm>
#include <cmath>

#include "raygrain/heuristics.h"

namespace raygrain {

namespace {

/// quality_k = (1 - |v_k| / (|v_x| + |v_y| + |v_z|))^2: the more the rays run along an axis, the worse a cut across it.
AxisOrder facing_axes(Vec3d v) {
  const Vec3d a{std::abs(v.x), std::abs(v.y), std::abs(v.z)};
  const double sum = a.x + a.y + a.z;
  const auto quality = [sum](double value) {
    const double rest = 1 - value / sum;
    return static_cast<float>(rest * rest);
  };
  return sorted_axes({quality(a.x), quality(a.y), quality(a.z)});
}

SplitOrientation facing_point(const PointArea& area) {
  return [eye = area.eye, forward = to_double(area.forward)](const NodeContext& node) {
    if (contains(node.bounds, eye)) return facing_axes(forward);
    const Vec3d middle = (to_double(node.bounds.lo) + to_double(node.bounds.hi)) * 0.5;
    return facing_axes(middle - to_double(eye));
  };
}

}  // namespace

SplitOrientation longest_axis_orientation() {
  return [](const NodeContext& node) {
    // In double: the extent of a huge box may overflow float.
    const Vec3d e = to_double(node.bounds.hi) - to_double(node.bounds.lo);
    const double longest = std::max({e.x, e.y, e.z});
    if (!(longest > 0)) return sorted_axes({1, 1, 1});
    return sorted_axes(to_float(e / longest));
  };
}

SplitOrientation facing_orientation(const InfluenceArea& area) {
  validate(area, area.name.empty() ? "area" : area.name);
  if (const auto* point = std::get_if<PointArea>(&area.shape)) return facing_point(*point);
  const AxisOrder order = facing_axes(to_double(std::get<PlaneArea>(area.shape).direction));
  return [order](const NodeContext&) { return order; };
}

SplitOrientation round_robin_orientation() {
  return [](const NodeContext& node) {
    // The second and third quality lie below the default threshold: one axis per level, unless it cannot be cut well.
    constexpr float kSecond = 0.2f, kThird = 0.1f;
    const int first = (node.parent_axis + 1) % 3;
    return AxisOrder{{AxisChoice{first, 1}, AxisChoice{(first + 1) % 3, kSecond}, AxisChoice{(first + 2) % 3, kThird}},
                     3};
  };
}

}  // namespace raygrain
