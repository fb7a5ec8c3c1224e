// How an accelerator answers: one ray along its route, and arrays of rays.
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <optional>
#include <vector>

#include "raygrain/accelerator.h"

#include "accel/accelerator_parts.h"
#include "accel/own_rays.h"
#include "accel/search.h"
#include "base/parallel.h"
#include "base/sizes.h"

namespace raygrain {

namespace {

TraceCounters* local_counters(AcceleratorCounters* counters) {
  return counters != nullptr ? &counters->local : nullptr;
}
TraceCounters* global_counters(AcceleratorCounters* counters) {
  return counters != nullptr ? &counters->global : nullptr;
}

constexpr size_t kChunk = 1024;

/// answer(begin, end, counters) for each chunk of rays; counters of chunks are summed.
template <class Answer>
void for_chunks(size_t rays, unsigned threads, AcceleratorCounters* counters, const Answer& answer) {
  std::mutex mutex;
  parallel_for(rays, kChunk, threads, [&](size_t begin, size_t end) {
    if (counters == nullptr) return answer(begin, end, nullptr);
    AcceleratorCounters own;
    own.areas.resize(counters->areas.size());
    answer(begin, end, &own);
    const std::lock_guard lock(mutex);
    counters->add(own);
  });
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

Hit Accelerator::intersect(const Ray& ray, AcceleratorCounters* counters) const {
  const Route& route = parts_->routes.nearest;
  if (counters == nullptr) {
    if (route.foreign.is_foreign(ray)) return parts_->global.intersect(ray, {}, {}, nullptr);
    if (const auto hit = nearest_covered(route, ray, nullptr)) return *hit;
  }
  parts_->count_areas(counters);
  return parts_->nearest(ray, route, counters);
}

bool Accelerator::occluded(const Ray& ray, AcceleratorCounters* counters) const {
  const Route& route = parts_->routes.any;
  if (counters == nullptr) {
    if (route.foreign.is_foreign(ray)) return parts_->global.occluded(ray, {}, nullptr);
    if (const auto hit = any_covered(route, ray, nullptr)) return *hit;
  }
  parts_->count_areas(counters);
  return parts_->any(ray, route, counters);
}

namespace {

/// Of a chunk, rays that are no area's go to the global tree together (many), the others one by one.
template <class Answer, class One, class Many>
void answer_chunk(const ForeignFilter& foreign, std::span<const Ray> part, std::span<Answer> room, const One& one,
                  const Many& many) {
  constexpr size_t kProbe = 31;
  constexpr size_t kFew = kChunk / 16;  // so few others are not worth a selection
  bool is_mixed = false;
  for (size_t i = 0; i < part.size(); i += kProbe) is_mixed |= !foreign.is_foreign(part[i]);
  if (!is_mixed) return many(part, room);
  std::array<uint32_t, kChunk> numbers;
  size_t foreigners = 0;
  for (size_t i = 0; i < part.size(); ++i) {
    numbers[foreigners] = static_cast<uint32_t>(i);
    foreigners += foreign.is_foreign(part[i]) ? 1 : 0;
  }
  if (part.size() - foreigners <= std::min(kFew, part.size() / 16)) return many(part, room);
  std::vector<Ray> gathered;
  gathered.reserve(foreigners);
  size_t next = 0;
  for (size_t i = 0; i < part.size(); ++i) {
    if (next < foreigners && numbers[next] == i) {
      gathered.push_back(part[i]);
      ++next;
    } else {
      room[i] = one(part[i]);
    }
  }
  std::vector<Answer> found(foreigners);
  many(gathered, found);
  for (size_t i = 0; i < foreigners; ++i) room[numbers[i]] = found[i];
}

}  // namespace

void Accelerator::intersect(std::span<const Ray> rays, std::span<Hit> hits, unsigned threads,
                            AcceleratorCounters* counters) const {
  check_sizes("Accelerator", rays.size(), hits.size());
  const std::optional<WideBvh>& global = parts_->global.wide();
  const Route& route = parts_->routes.nearest_of_many;
  if (global && counters == nullptr && route.foreign.is_trivial()) return global->intersect(rays, hits, threads);
  parts_->count_areas(counters);
  for_chunks(rays.size(), threads, counters, [&](size_t begin, size_t end, AcceleratorCounters* count) {
    const auto one_by_one = [&](std::span<const Ray> some, std::span<Hit> found, const Route& way) {
      for (size_t i = 0; i < some.size(); ++i) found[i] = parts_->nearest(some[i], way, count);
    };
    const auto part = rays.subspan(begin, end - begin);
    const auto room = hits.subspan(begin, end - begin);
    if (!global) return one_by_one(part, room, route);
    answer_chunk(
        route.foreign, part, room, [&](const Ray& ray) { return parts_->nearest(ray, route, count); },
        [&](std::span<const Ray> some, std::span<Hit> found) {
          if (count != nullptr) return one_by_one(some, found, {});
          global->intersect(some, found);
        });
  });
}

void Accelerator::occluded(std::span<const Ray> rays, std::span<uint8_t> flags, unsigned threads,
                           AcceleratorCounters* counters) const {
  check_sizes("Accelerator", rays.size(), flags.size());
  const std::optional<WideBvh>& global = parts_->global.wide();
  const Route& route = parts_->routes.any_of_many;
  if (global && counters == nullptr && route.foreign.is_trivial()) return global->occluded(rays, flags, threads);
  parts_->count_areas(counters);
  for_chunks(rays.size(), threads, counters, [&](size_t begin, size_t end, AcceleratorCounters* count) {
    const auto one_by_one = [&](std::span<const Ray> some, std::span<uint8_t> found, const Route& way) {
      for (size_t i = 0; i < some.size(); ++i) found[i] = parts_->any(some[i], way, count) ? 1 : 0;
    };
    const auto part = rays.subspan(begin, end - begin);
    const auto room = flags.subspan(begin, end - begin);
    if (!global) return one_by_one(part, room, route);
    answer_chunk(
        route.foreign, part, room, [&](const Ray& ray) { return static_cast<uint8_t>(parts_->any(ray, route, count)); },
        [&](std::span<const Ray> some, std::span<uint8_t> found) {
          if (count != nullptr) return one_by_one(some, found, {});
          global->occluded(some, found);
        });
  });
}

}  // namespace raygrain
