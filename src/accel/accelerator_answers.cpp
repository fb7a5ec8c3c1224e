// How an accelerator answers: one ray along its route, and arrays of rays.
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <optional>
#include <vector>

#include "raygrain/accelerator.h"

#include "accel/accelerator_parts.h"
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

/// answer(i, counters) for each ray; counters of threads are summed.
template <class Answer>
void for_chunks(size_t rays, unsigned threads, AcceleratorCounters* counters, const Answer& answer) {
  constexpr size_t kChunk = 1024;
  std::mutex mutex;
  parallel_for(rays, kChunk, threads, [&](size_t begin, size_t end) {
    AcceleratorCounters own;
    for (size_t i = begin; i < end; ++i) answer(i, counters != nullptr ? &own : nullptr);
    if (counters == nullptr) return;
    const std::lock_guard lock(mutex);
    counters->add(own);
  });
}

/// Rays along an area that its coverage answers, whatever region they are in.
std::optional<Hit> nearest_covered(const Route& route, const Ray& ray) {
  for (const Coverage& coverage : route.asked)
    if (const auto hit = coverage.intersect(ray)) return hit;
  return {};
}
std::optional<bool> any_covered(const Route& route, const Ray& ray) {
  for (const Coverage& coverage : route.asked)
    if (const auto hit = coverage.occluded(ray)) return hit;
  return {};
}

/// Are all hits of the ray that can be nearer than `best` known, when those with t <= exit are?
bool is_final(const Hit& best, const Ray& ray, float exit) {
  return std::min(best.t, ray.tmax) <= exit;
}

}  // namespace

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
  if (const auto hit = nearest_covered(route, ray)) {
    if (counters != nullptr) ++counters->covered;
    return *hit;
  }
  Hit best;
  SearchOptions options;
  if (route.searches_some) {
    AreaWalk walk(areas, ray, route.searches, counters);
    while (const auto stage = walk.next()) {
      count_use(stage->area, ray, counters);
      best = searches[stage->area].intersect(ray, best, walk.search_options(), local_counters(counters));
      if (!is_final(best, ray, stage->exit)) continue;
      if (counters != nullptr && is_hit(best)) ++counters->local_hits;
      return best;
    }
    options = walk.search_options();
  }
  if (counters != nullptr) ++counters->global_searches;
  return global.intersect(ray, best, options, global_counters(counters));
}

bool Accelerator::Parts::any(const Ray& ray, const Route& route, AcceleratorCounters* counters) const {
  if (counters != nullptr) ++counters->rays;
  if (!is_valid(ray)) {
    if (counters != nullptr) ++counters->invalid_rays;
    return false;
  }
  if (const auto hit = any_covered(route, ray)) {
    if (counters != nullptr) ++counters->covered;
    return *hit;
  }
  SearchOptions options;
  if (route.searches_some) {
    AreaWalk walk(areas, ray, route.searches, counters);
    while (const auto stage = walk.next()) {
      count_use(stage->area, ray, counters);
      if (searches[stage->area].occluded(ray, walk.search_options(), local_counters(counters))) {
        if (counters != nullptr) ++counters->local_hits;  // wherever it is: any hit answers
        return true;
      }
      if (is_final({}, ray, stage->exit)) return false;
    }
    options = walk.search_options();
  }
  if (counters != nullptr) ++counters->global_searches;
  return global.occluded(ray, options, global_counters(counters));
}

Hit Accelerator::intersect(const Ray& ray, AcceleratorCounters* counters) const {
  const Route& route = parts_->routes.nearest;
  if (counters == nullptr) {
    if (route.foreign.is_foreign(ray)) return parts_->global.intersect(ray, {}, {}, nullptr);
    if (const auto hit = nearest_covered(route, ray)) return *hit;
  }
  return parts_->nearest(ray, route, counters);
}

bool Accelerator::occluded(const Ray& ray, AcceleratorCounters* counters) const {
  const Route& route = parts_->routes.any;
  if (counters == nullptr) {
    if (route.foreign.is_foreign(ray)) return parts_->global.occluded(ray, {}, nullptr);
    if (const auto hit = any_covered(route, ray)) return *hit;
  }
  return parts_->any(ray, route, counters);
}

template <class Answer, class One, class Many>
void Accelerator::Parts::answer_array(const ForeignFilter& foreign, std::span<const Ray> rays,
                                      std::span<Answer> answers, unsigned threads, const One& one,
                                      const Many& many) const {
  constexpr size_t kChunk = 1024, kProbe = 31;
  constexpr size_t kFew = kChunk / 16;  // so few others are not worth a selection
  parallel_for(rays.size(), kChunk, threads, [&](size_t begin, size_t end) {
    bool is_mixed = false;
    for (size_t i = begin; i < end; i += kProbe) is_mixed |= !foreign.is_foreign(rays[i]);
    if (!is_mixed) return many(rays.subspan(begin, end - begin), answers.subspan(begin, end - begin));
    std::array<uint32_t, kChunk> numbers;
    size_t foreigners = 0;
    for (size_t i = begin; i < end; ++i) {
      numbers[foreigners] = static_cast<uint32_t>(i - begin);
      foreigners += foreign.is_foreign(rays[i]) ? 1 : 0;
    }
    const std::span<const Ray> part = rays.subspan(begin, end - begin);
    const std::span<Answer> room = answers.subspan(begin, end - begin);
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
  });
}

void Accelerator::intersect(std::span<const Ray> rays, std::span<Hit> hits, unsigned threads,
                            AcceleratorCounters* counters) const {
  check_sizes("Accelerator", rays.size(), hits.size());
  const std::optional<WideBvh>& global = parts_->global.wide();
  const Route& route = parts_->routes.nearest_of_many;
  if (counters != nullptr || !global)
    return for_chunks(rays.size(), threads, counters,
                      [&](size_t i, AcceleratorCounters* count) { hits[i] = parts_->nearest(rays[i], route, count); });
  if (route.foreign.is_trivial()) return global->intersect(rays, hits, threads);
  parts_->answer_array(
      route.foreign, rays, hits, threads, [&](const Ray& ray) { return parts_->nearest(ray, route, nullptr); },
      [&](std::span<const Ray> some, std::span<Hit> found) { global->intersect(some, found); });
}

void Accelerator::occluded(std::span<const Ray> rays, std::span<uint8_t> flags, unsigned threads,
                           AcceleratorCounters* counters) const {
  check_sizes("Accelerator", rays.size(), flags.size());
  const std::optional<WideBvh>& global = parts_->global.wide();
  const Route& route = parts_->routes.any_of_many;
  if (counters != nullptr || !global)
    return for_chunks(rays.size(), threads, counters, [&](size_t i, AcceleratorCounters* count) {
      flags[i] = parts_->any(rays[i], route, count) ? 1 : 0;
    });
  if (route.foreign.is_trivial()) return global->occluded(rays, flags, threads);
  parts_->answer_array(
      route.foreign, rays, flags, threads,
      [&](const Ray& ray) { return static_cast<uint8_t>(parts_->any(ray, route, nullptr)); },
      [&](std::span<const Ray> some, std::span<uint8_t> found) { global->occluded(some, found); });
}

}  // namespace raygrain
