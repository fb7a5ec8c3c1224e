// How an accelerator answers one ray, along its route.
#include <algorithm>
#include <cmath>
#include <optional>

#include "raygrain/accelerator.h"

#include "accel/accelerator_parts.h"
#include "accel/own_rays.h"
#include "accel/search.h"

namespace raygrain {

namespace {

TraceCounters* local_counters(AcceleratorCounters* counters) {
  return counters != nullptr ? &counters->local : nullptr;
}
TraceCounters* global_counters(AcceleratorCounters* counters) {
  return counters != nullptr ? &counters->global : nullptr;
}

void count_covered(uint32_t area, AcceleratorCounters* counters) {
  if (counters == nullptr) return;
  ++counters->covered;
  if (area < counters->areas.size()) ++counters->areas[area].covered;
}

/// Rays along an area that its coverage answers, whatever region they are in.
std::optional<Hit> nearest_covered(const Route& route, const Ray& ray, AcceleratorCounters* counters) {
  return route.asked.first_answer(ray, [&](const Coverage& coverage, uint32_t area) {
    const std::optional<Hit> hit = coverage.intersect(ray);
    if (hit) count_covered(area, counters);
    return hit;
  });
}
std::optional<bool> any_covered(const Route& route, const Ray& ray, AcceleratorCounters* counters) {
  return route.asked.first_answer(ray, [&](const Coverage& coverage, uint32_t area) {
    const std::optional<bool> hit = coverage.occluded(ray);
    if (hit) count_covered(area, counters);
    return hit;
  });
}

void count_local(uint32_t area, bool is_local_hit, AcceleratorCounters* counters) {
  if (counters == nullptr) return;
  counters->local_hits += is_local_hit ? 1 : 0;
  if (area < counters->areas.size()) ++counters->areas[area].local;
}

/// Are all hits of the ray that can be nearer than `best` known, when those with t <= exit are?
bool is_final(const Hit& best, const Ray& ray, float exit) {
  return std::min(best.t, ray.tmax) <= exit;
}

}  // namespace

void Accelerator::Parts::count_areas(AcceleratorCounters* counters) const {
  if (counters != nullptr) counters->areas.resize(std::max(counters->areas.size(), geometries.size()));
}

void Accelerator::Parts::count_global(const Ray& ray, AcceleratorCounters* counters) const {
  if (counters == nullptr) return;
  ++counters->global_searches;
  for (size_t i = 0; i < std::min(geometries.size(), counters->areas.size()); ++i)
    counters->areas[i].global += is_own_ray(geometries[i], ray) ? 1 : 0;
}

void Accelerator::Parts::count_use(uint32_t area, const Ray& ray, AcceleratorCounters* counters) const {
  const std::optional<FrameTree>& tree = searches[area].in_ray_space();
  if (counters == nullptr || !tree) return;
  const FrameUse use = tree->use_of(ray);
  counters->columns += use == FrameUse::kColumn;
  counters->cones += use == FrameUse::kCone;
}

Hit Accelerator::Parts::nearest(const Ray& ray, const Route& route, AcceleratorCounters* counters) const {
  if (counters != nullptr) ++counters->rays;
  if (!is_valid(ray)) {
    if (counters != nullptr) ++counters->invalid_rays;
    return {};
  }
  if (const auto hit = nearest_covered(route, ray, counters)) return *hit;
  return nearest_by_trees(ray, route, counters);
}

Hit Accelerator::Parts::nearest_by_trees(const Ray& ray, const Route& route, AcceleratorCounters* counters) const {
  Hit best;
  SearchOptions options;
  if (route.searches_some) {
    AreaWalk walk(areas, ray, route.searches, counters);
    while (const auto stage = walk.next()) {
      count_use(stage->area, ray, counters);
      best = searches[stage->area].intersect(ray, best, walk.search_options(), local_counters(counters));
      if (!is_final(best, ray, stage->exit)) continue;
      count_local(stage->area, is_hit(best), counters);
      return best;
    }
    options = walk.search_options();
  }
  count_global(ray, counters);
  return global.intersect(ray, best, options, global_counters(counters));
}

bool Accelerator::Parts::any(const Ray& ray, const Route& route, AcceleratorCounters* counters) const {
  if (counters != nullptr) ++counters->rays;
  if (!is_valid(ray)) {
    if (counters != nullptr) ++counters->invalid_rays;
    return false;
  }
  if (const auto hit = any_covered(route, ray, counters)) return *hit;
  return any_by_trees(ray, route, counters);
}

bool Accelerator::Parts::any_by_trees(const Ray& ray, const Route& route, AcceleratorCounters* counters) const {
  SearchOptions options;
  if (route.searches_some) {
    AreaWalk walk(areas, ray, route.searches, counters);
    while (const auto stage = walk.next()) {
      count_use(stage->area, ray, counters);
      if (searches[stage->area].occluded(ray, walk.search_options(), local_counters(counters))) {
        count_local(stage->area, true, counters);  // wherever the hit is: any answers
        return true;
      }
      if (!is_final({}, ray, stage->exit)) continue;
      count_local(stage->area, false, counters);
      return false;
    }
    options = walk.search_options();
  }
  count_global(ray, counters);
  return global.occluded(ray, options, global_counters(counters));
}

template <>
Hit Accelerator::Parts::answer_one<Hit>(const Ray& ray, AcceleratorCounters* counters) const {
  const Route& route = routes.nearest;
  if (counters == nullptr) {
    if (route.foreign.is_foreign(ray)) return global.intersect(ray, {}, {}, nullptr);
    if (const auto hit = nearest_covered(route, ray, nullptr)) return *hit;
    return is_valid(ray) ? nearest_by_trees(ray, route, nullptr) : Hit{};
  }
  count_areas(counters);
  return nearest(ray, route, counters);
}

template <>
uint8_t Accelerator::Parts::answer_one<uint8_t>(const Ray& ray, AcceleratorCounters* counters) const {
  const Route& route = routes.any;
  if (counters == nullptr) {
    if (route.foreign.is_foreign(ray)) return global.occluded(ray, {}, nullptr) ? 1 : 0;
    if (const auto hit = any_covered(route, ray, nullptr)) return *hit ? 1 : 0;
    return is_valid(ray) && any_by_trees(ray, route, nullptr) ? 1 : 0;
  }
  count_areas(counters);
  return any(ray, route, counters) ? 1 : 0;
}

Hit Accelerator::intersect(const Ray& ray, AcceleratorCounters* counters) const {
  return parts_->answer_one<Hit>(ray, counters);
}

bool Accelerator::occluded(const Ray& ray, AcceleratorCounters* counters) const {
  return parts_->answer_one<uint8_t>(ray, counters) != 0;
}

}  // namespace raygrain
