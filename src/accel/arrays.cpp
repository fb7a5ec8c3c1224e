// Arrays of rays of any kind. Of each chunk those that a batch call could have go to the coverages of areas together,
// those that concern no area to the global tree together, the others one by one.
#include <algorithm>
#include <mutex>
#include <vector>

#include "raygrain/accelerator.h"

#include "accel/accelerator_parts.h"
#include "accel/bundles.h"
#include "base/parallel.h"
#include "base/sizes.h"

namespace raygrain {

namespace {

/// So few rays are not worth an array. Measured: docs/performance-rays.md, "How many rays a call".
constexpr size_t kFewRays = 2;
/// Rays of a chunk, of which those with something in common are gathered: many of them share cells and nodes.
constexpr size_t kLeastChunk = 1024, kMostChunk = 16384;
constexpr size_t kChunks = 16;  // at least, where there are enough rays: for threads
/// Such a share of rays of areas is not worth a selection.
constexpr size_t kFewOwn = 16;

/// From a few rays: does any concern an area?
bool are_foreign(const ForeignFilter& filter, std::span<const Ray> rays) {
  constexpr size_t kProbe = 63;
  for (size_t i = 0; i < rays.size(); i += kProbe)
    if (!filter.is_foreign(rays[i])) return false;
  return true;
}

}  // namespace

template <class Answer>
void Accelerator::Parts::answer_along(const Route& route, std::span<const Ray> rays, std::span<Answer> answers,
                                      AcceleratorCounters* counters) const {
  for (size_t i = 0; i < rays.size(); ++i) {
    if constexpr (kIsAny<Answer>)
      answers[i] = any(rays[i], route, counters) ? 1 : 0;
    else
      answers[i] = nearest(rays[i], route, counters);
  }
}

template <class Answer>
void Accelerator::Parts::answer_by_global(std::span<const Ray> rays, std::span<Answer> answers,
                                          AcceleratorCounters* counters) const {
  if (counters != nullptr || !global.wide()) return answer_along<Answer>({}, rays, answers, counters);
  if constexpr (kIsAny<Answer>)
    global.wide()->occluded(rays, answers);
  else
    global.wide()->intersect(rays, answers);
}

template <class Answer>
void Accelerator::Parts::answer_by_trees(std::span<const Ray> rays, std::span<Answer> answers,
                                         AcceleratorCounters* counters) const {
  const Route& route = route_of_many<Answer>();
  if (!route.searches_some) return answer_by_global<Answer>(rays, answers, counters);
  answer_along<Answer>(route, rays, answers, counters);
}

/// Some rays of an array, by number.
template <class Answer>
void Accelerator::Parts::answer_gathered(std::span<const Ray> rays, std::span<const uint32_t> numbers,
                                         std::span<Answer> answers, AcceleratorCounters* counters) const {
  std::vector<Ray> gathered;
  gathered.reserve(numbers.size());
  for (const uint32_t number : numbers) gathered.push_back(rays[number]);
  std::vector<Answer> found(numbers.size());
  answer_by_global<Answer>(gathered, found, counters);
  for (size_t i = 0; i < numbers.size(); ++i) answers[numbers[i]] = found[i];
}

template <class Answer>
void Accelerator::Parts::answer_chunk(std::span<const Ray> rays, std::span<Answer> answers,
                                      AcceleratorCounters* counters) const {
  const Route& route = route_of_many<Answer>();
  const bool are_some_alone = route.searches_some || !route.asked.is_empty();
  if (are_foreign(route.foreign, rays)) return answer_by_global<Answer>(rays, answers, counters);
  const Bundles bundles(route.batches, kIsAny<Answer>, rays);
  if (bundles.size() == 0 && !are_some_alone) return answer_by_global<Answer>(rays, answers, counters);

  std::vector<uint32_t> together, alone;
  together.reserve(rays.size());
  const auto sort_out = [&](uint32_t number) {
    (are_some_alone && !route.foreign.is_foreign(rays[number]) ? alone : together).push_back(number);
  };
  std::ranges::for_each(bundles.others(), sort_out);
  for (uint32_t i = 0; i < rays.size() && bundles.size() == 0; ++i) sort_out(i);
  const size_t own = rays.size() - together.size();
  if (own <= rays.size() / kFewOwn) return answer_by_global<Answer>(rays, answers, counters);

  std::vector<uint32_t>& waiting = route.searches_some ? alone : together;
  for (size_t k = 0; k < bundles.size(); ++k)
    if (const auto some = bundles.rays(k); !some.empty())
      if (!ask_coverages<Answer>(route.batches, {bundles.shared(k), bundles.points(), answers, some}, waiting, 1,
                                 counters))
        waiting.insert(waiting.end(), some.begin(), some.end());
  for (const uint32_t number : alone)
    answer_along<Answer>(route, rays.subspan(number, 1), answers.subspan(number, 1), counters);
  answer_gathered<Answer>(rays, together, answers, counters);
}

template <class Answer>
void Accelerator::Parts::answer_array(std::span<const Ray> rays, std::span<Answer> answers, unsigned threads,
                                      AcceleratorCounters* counters) const {
  check_sizes("Accelerator", rays.size(), answers.size());
  const Route& route = route_of_many<Answer>();
  if (counters == nullptr && global.wide() && route.foreign.is_trivial() && rays.size() > kFewRays) {
    if constexpr (kIsAny<Answer>)
      return global.wide()->occluded(rays, answers, threads);
    else
      return global.wide()->intersect(rays, answers, threads);
  }
  count_areas(counters);
  if (rays.size() <= kFewRays) {
    for (size_t i = 0; i < rays.size(); ++i) answers[i] = answer_one<Answer>(rays[i], counters);
    return;
  }
  std::mutex mutex;
  const size_t counted_areas = counters != nullptr ? counters->areas.size() : 0;
  const size_t chunk = std::clamp(rays.size() / kChunks, kLeastChunk, kMostChunk);
  parallel_for(rays.size(), chunk, threads, [&](size_t begin, size_t end) {
    const std::span<const Ray> part = rays.subspan(begin, end - begin);
    const std::span<Answer> room = answers.subspan(begin, end - begin);
    if (counters == nullptr) return answer_chunk<Answer>(part, room, nullptr);
    AcceleratorCounters own;
    own.areas.resize(counted_areas);
    answer_chunk<Answer>(part, room, &own);
    const std::lock_guard lock(mutex);
    counters->add(own);
  });
}

template void Accelerator::Parts::answer_array(std::span<const Ray>, std::span<uint8_t>, unsigned,
                                               AcceleratorCounters*) const;
template void Accelerator::Parts::answer_array(std::span<const Ray>, std::span<Hit>, unsigned,
                                               AcceleratorCounters*) const;
template void Accelerator::Parts::answer_by_trees(std::span<const Ray>, std::span<uint8_t>, AcceleratorCounters*) const;
template void Accelerator::Parts::answer_by_trees(std::span<const Ray>, std::span<Hit>, AcceleratorCounters*) const;

void Accelerator::intersect(std::span<const Ray> rays, std::span<Hit> hits, unsigned threads,
                            AcceleratorCounters* counters) const {
  parts_->answer_array<Hit>(rays, hits, threads, counters);
}

void Accelerator::occluded(std::span<const Ray> rays, std::span<uint8_t> flags, unsigned threads,
                           AcceleratorCounters* counters) const {
  parts_->answer_array<uint8_t>(rays, flags, threads, counters);
}

}  // namespace raygrain
