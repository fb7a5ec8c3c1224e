#include "accel/search.h"

#include <algorithm>

namespace raygrain {

namespace {

/// The ray as it goes on from parameter t.
Ray moved_along(const Ray& ray, float t) {
  const Vec3d point = to_double(ray.origin) + to_double(ray.direction) * static_cast<double>(t);
  return {to_float(point), ray.direction, ray.tmin, ray.tmax};
}

}  // namespace

AxisTest::AxisTest(const AreaGeometry& area)
    : axis_(area.is_plane() ? area.frame().forward : area.frame().origin), is_plane_(area.is_plane()) {
  // A little less than is_direction_affine asks for.
  const double least = std::max(0.0, 1 - static_cast<double>(area.area().tolerance) - 0x1p-40);
  least_ = least * least * (1 - 0x1p-40);
}

AreaWalk::AreaWalk(const AreaTable& areas, const Ray& ray, std::span<const uint8_t> allowed,
                   AcceleratorCounters* counters)
    : areas_(areas), ray_(ray), allowed_(allowed), counters_(counters) {}

std::optional<AreaWalk::Stage> AreaWalk::next() {
  if (areas_.geometries.empty()) return {};
  if (ray_.tmin < 0) return {};  // hits behind the origin: no area's region certifies anything about them
  if (!started_ && !may_be_served()) return {};
  if (started_) search_.skip_before = from_;
  const Ray here = started_ ? moved_along(ray_, from_) : ray_;
  while (tried_count_ < kMaxStages) {
    const std::optional<uint32_t> area = cheapest_serving(here);
    if (!area) return {};
    tried_[tried_count_++] = *area;
    const float exit = certain_exit(*area);
    if (!(exit > from_)) continue;
    if (started_) count(&AcceleratorCounters::continued);
    started_ = true;
    count(&AcceleratorCounters::local_searches);
    from_ = exit;
    return Stage{*area, exit};
  }
  return {};
}

bool AreaWalk::may_be_served() const {
  constexpr size_t kFew = 16;  // more are looked up by place
  if (areas_.axes.size() > kFew) return true;
  return std::ranges::any_of(areas_.axes, [&](const AxisTest& axis) { return axis(ray_); });
}

bool AreaWalk::was_tried(uint32_t area) const {
  const auto tried = std::span(tried_).first(tried_count_);
  return std::ranges::find(tried, area) != tried.end();
}

std::optional<uint32_t> AreaWalk::cheapest_serving(const Ray& from_here) {
  std::optional<uint32_t> best;
  for (const uint32_t area : areas_.top_level.regions_at(from_here.origin)) {
    if (allowed_[area] == 0 || was_tried(area)) continue;
    count(&AcceleratorCounters::areas_tested);
    if (!areas_.geometries[area].serves(from_here)) continue;
    count(&AcceleratorCounters::areas_serving);
    if (!best || areas_.ranks[area] < areas_.ranks[*best]) best = area;
  }
  return best;
}

float AreaWalk::certain_exit(uint32_t area) const {
  const ConvexRegion& region = areas_.geometries[area].region();
  if (!started_) return exit_distance(region, ray_);
  const RayInterval inside = inside_interval(region, ray_);
  return inside.enter <= from_ ? inside.exit : -kInf;
}

}  // namespace raygrain
