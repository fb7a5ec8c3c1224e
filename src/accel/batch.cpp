// Rays that share a direction or a point: to the coverage of the areas that have it, what is left to the trees. Few
// rays go one by one.
#include <mutex>

#include "raygrain/accelerator.h"

#include "accel/accelerator_parts.h"
#include "base/parallel.h"
#include "base/sizes.h"

namespace raygrain {

namespace {

/// Rays number(0) ... number(count - 1). trace(rays, answers, counters) answers an array.
template <class Answer, class Number, class Trace>
void trace_some(const SharedRays<Answer>& batch, size_t count, const Number& number, unsigned threads,
                AcceleratorCounters* counters, const Trace& trace) {
  constexpr size_t kChunk = 2048;
  std::mutex mutex;
  const size_t areas = counters != nullptr ? counters->areas.size() : 0;
  parallel_for(count, kChunk, threads, [&](size_t begin, size_t end) {
    AcceleratorCounters own;
    own.areas.resize(areas);
    std::vector<Ray> rays(end - begin);
    std::vector<Answer> found(end - begin);
    for (size_t i = begin; i < end; ++i) rays[i - begin] = batch.shared.ray(kIsAny<Answer>, batch.points[number(i)]);
    trace(rays, found, counters != nullptr ? &own : nullptr);
    for (size_t i = begin; i < end; ++i) batch.answers[number(i)] = found[i - begin];
    if (counters == nullptr) return;
    const std::lock_guard lock(mutex);
    counters->add(own);
  });
}

}  // namespace

template <class Answer>
void Accelerator::Parts::answer_batch(const Shared& shared, std::span<const Vec3> points, std::span<Answer> answers,
                                      unsigned threads, AcceleratorCounters* counters) const {
  constexpr size_t kMost = size_t{1} << 31;  // numbers of rays have 32 bits
  check_sizes("Accelerator", points.size(), answers.size());
  if (points.size() > kMost) {
    answer_batch(shared, points.first(kMost), answers.first(kMost), threads, counters);
    return answer_batch(shared, points.subspan(kMost), answers.subspan(kMost), threads, counters);
  }
  count_areas(counters);
  const SharedRays<Answer> batch{shared, points, answers, {}};
  const auto answer_any = [&](std::span<const Ray> rays, std::span<Answer> found, AcceleratorCounters* count) {
    answer_array<Answer>(rays, found, 1, count);
  };
  const auto itself = [](size_t i) { return i; };
  const Route& route = route_of_many<Answer>();
  if (points.size() < least_rays(route.batches, shared)) {
    const ForeignFilter& foreign = route_of_one<Answer>().foreign;
    if (!points.empty() && foreign.is_foreign(shared.ray(kIsAny<Answer>, points[0])))
      return trace_some(batch, points.size(), itself, 1, counters, answer_any);
    for (size_t i = 0; i < points.size(); ++i)
      answers[i] = answer_one<Answer>(shared.ray(kIsAny<Answer>, points[i]), counters);
    return;
  }
  std::vector<uint32_t> rest;
  if (!ask_coverages(route.batches, batch, rest, threads, counters))
    return trace_some(batch, points.size(), itself, threads, counters, answer_any);
  trace_some(
      batch, rest.size(), [&](size_t i) { return rest[i]; }, threads, counters,
      [&](std::span<const Ray> rays, std::span<Answer> found, AcceleratorCounters* count) {
        answer_by_trees<Answer>(rays, found, count);
      });
}

void Accelerator::occluded(std::span<const Vec3> origins, Vec3 direction, std::span<uint8_t> flags, unsigned threads,
                           AcceleratorCounters* counters) const {
  parts_->answer_batch<uint8_t>({direction, false}, origins, flags, threads, counters);
}

void Accelerator::intersect(std::span<const Vec3> origins, Vec3 direction, std::span<Hit> hits, unsigned threads,
                            AcceleratorCounters* counters) const {
  parts_->answer_batch<Hit>({direction, false}, origins, hits, threads, counters);
}

void Accelerator::occluded_towards(std::span<const Vec3> origins, Vec3 point, std::span<uint8_t> flags,
                                   unsigned threads, AcceleratorCounters* counters) const {
  parts_->answer_batch<uint8_t>({point, true}, origins, flags, threads, counters);
}

void Accelerator::intersect_from(Vec3 eye, std::span<const Vec3> directions, std::span<Hit> hits, unsigned threads,
                                 AcceleratorCounters* counters) const {
  parts_->answer_batch<Hit>({eye, true}, directions, hits, threads, counters);
}

}  // namespace raygrain
