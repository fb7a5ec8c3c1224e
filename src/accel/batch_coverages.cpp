#include "accel/batch_coverages.h"

#include <algorithm>
#include <utility>

namespace raygrain {
namespace {

template <class Answer>
void ask(const Coverage& coverage, const SharedRays<Answer>& rays, std::span<const uint32_t> numbers,
         std::vector<uint32_t>& rest, unsigned threads) {
  const Vec3 shared = rays.shared.value;
  if constexpr (kIsAny<Answer>) {
    if (rays.shared.is_point)
      coverage.occluded_towards(rays.points, shared, rays.answers, rest, numbers, threads);
    else
      coverage.occluded(rays.points, shared, rays.answers, rest, numbers, threads);
  } else {
    if (rays.shared.is_point)
      coverage.intersect_from(shared, rays.points, rays.answers, rest, numbers, threads);
    else
      coverage.intersect(rays.points, shared, rays.answers, rest, numbers, threads);
  }
}

void count(const AreaCoverage& coverage, uint64_t answered, AcceleratorCounters* counters) {
  if (counters == nullptr) return;
  counters->rays += answered;
  counters->covered += answered;
  if (coverage.area < counters->areas.size()) counters->areas[coverage.area].covered += answered;
}

/// One coverage after the other: each is asked about what those before it left.
template <class Answer>
bool ask_in_turn(std::span<const AreaCoverage> coverages, const SharedRays<Answer>& rays, std::vector<uint32_t>& rest,
                 unsigned threads, AcceleratorCounters* counters) {
  const int wanted = kIsAny<Answer> ? 1 : -1;
  std::vector<uint32_t> waiting;
  std::span<const uint32_t> numbers = rays.numbers;
  size_t left = numbers.empty() ? rays.points.size() : numbers.size();
  bool is_asked = false;
  for (const AreaCoverage& c : coverages) {
    if (is_asked && waiting.empty()) break;
    if (!rays.shared.is_point && c.coverage.sense(rays.shared.value) != wanted) continue;
    std::vector<uint32_t> others;
    ask(c.coverage, rays, numbers, others, threads);
    count(c, left - others.size(), counters);
    waiting = std::move(others);
    numbers = waiting;
    left = waiting.size();
    is_asked = true;
  }
  rest.insert(rest.end(), waiting.begin(), waiting.end());
  return is_asked;
}

/// Each coverage about the eye gets the rays in its own window.
template <class Answer>
void divide(std::span<const AreaCoverage> coverages, const SharedRays<Answer>& rays, std::vector<uint32_t>& rest,
            unsigned threads, AcceleratorCounters* counters) {
  std::vector<const Coverage*> asked;
  for (const AreaCoverage& c : coverages) asked.push_back(&c.coverage);
  std::vector<Vec3> some;
  for (const uint32_t number : rays.numbers) some.push_back(rays.points[number]);
  const std::span<const Vec3> points = rays.numbers.empty() ? rays.points : std::span<const Vec3>(some);
  const size_t begin = rest.size();
  auto lists = Coverage::divide(asked, points, !kIsAny<Answer>, rest, threads);
  if (!rays.numbers.empty()) {
    for (std::vector<uint32_t>& list : lists)
      for (uint32_t& number : list) number = rays.numbers[number];
    for (size_t i = begin; i < rest.size(); ++i) rest[i] = rays.numbers[rest[i]];
  }
  const size_t unserved = rest.size();
  for (size_t i = 0; i < lists.size(); ++i) {
    if (lists[i].empty()) continue;
    const size_t before = rest.size();
    ask(coverages[i].coverage, rays, std::span<const uint32_t>(lists[i]), rest, threads);
    count(coverages[i], lists[i].size() - (rest.size() - before), counters);
  }
  if (rest.size() > unserved) std::sort(rest.begin() + static_cast<std::ptrdiff_t>(begin), rest.end());
}

}  // namespace

size_t BatchCoverages::memory_bytes() const {
  size_t bytes = planes.capacity() * sizeof(AreaCoverage) + eyes.capacity() * sizeof(Eye);
  for (const Eye& eye : eyes) bytes += eye.coverages.capacity() * sizeof(AreaCoverage);
  return bytes;
}

template <class Answer>
bool ask_coverages(const BatchCoverages& coverages, const SharedRays<Answer>& rays, std::vector<uint32_t>& rest,
                   unsigned threads, AcceleratorCounters* counters) {
  if (!rays.shared.is_point) return ask_in_turn<Answer>(coverages.planes, rays, rest, threads, counters);
  const BatchCoverages::Eye* eye = coverages.find(rays.shared.value);
  if (eye == nullptr) return false;
  if (eye->coverages.size() == 1) return ask_in_turn<Answer>(eye->coverages, rays, rest, threads, counters);
  divide<Answer>(eye->coverages, rays, rest, threads, counters);
  return true;
}

template bool ask_coverages(const BatchCoverages&, const SharedRays<uint8_t>&, std::vector<uint32_t>&, unsigned,
                            AcceleratorCounters*);
template bool ask_coverages(const BatchCoverages&, const SharedRays<Hit>&, std::vector<uint32_t>&, unsigned,
                            AcceleratorCounters*);

}  // namespace raygrain
