// Rays that share a direction or a point: to the coverage of the areas that have it, what is left ray by ray.
#include <algorithm>
#include <mutex>
#include <string>
#include <utility>

#include "raygrain/accelerator.h"
#include "raygrain/error.h"

#include "base/parallel.h"
#include "base/sizes.h"

namespace raygrain {

namespace {

/// Rays of which some still wait for their answer.
class Waiting {
 public:
  /// Counts what `coverages` (one for each area) answer, where there are counters.
  Waiting(size_t count, std::span<const Coverage> coverages, AcceleratorCounters* counters)
      : count_(count), coverages_(coverages), counters_(counters) {
    if (counters_ != nullptr) counters_->areas.resize(std::max(counters_->areas.size(), coverages.size()));
  }

  bool is_empty() const { return count_ == 0 || (started_ && numbers_.empty()); }

  /// Lets ask(coverage, numbers, rest) answer those that wait (no numbers: all of them), and keeps the rest.
  template <class Ask>
  void offer(const Coverage& coverage, const Ask& ask) {
    const size_t before = left();
    std::vector<uint32_t> rest;
    ask(coverage, std::span<const uint32_t>(numbers_), rest);
    numbers_ = std::move(rest);
    started_ = true;
    count(coverage, before - numbers_.size());
  }

  /// The same with several coverages about one eye: each gets its own.
  template <class Ask>
  void divide(const std::vector<const Coverage*>& coverages, std::span<const Vec3> points, bool are_directions,
              unsigned threads, const Ask& ask) {
    started_ = true;
    const auto lists = Coverage::divide(coverages, points, are_directions, numbers_, threads);
    const size_t unserved = numbers_.size();
    for (size_t i = 0; i < lists.size(); ++i) {
      if (lists[i].empty()) continue;
      const size_t before = numbers_.size();
      ask(*coverages[i], std::span<const uint32_t>(lists[i]), numbers_);
      count(*coverages[i], lists[i].size() - (numbers_.size() - before));
    }
    if (numbers_.size() > unserved) std::ranges::sort(numbers_);
  }

  /// The last resort: rays of any kind. trace(rays, answers, counters) answers an array.
  template <class Answer, class MakeRay, class Trace>
  void trace_rest(std::span<Answer> answers, unsigned threads, const MakeRay& make_ray, const Trace& trace) const {
    constexpr size_t kChunk = 2048;
    std::mutex mutex;
    parallel_for(left(), kChunk, threads, [&](size_t begin, size_t end) {
      AcceleratorCounters own;
      AcceleratorCounters* counters = counters_ != nullptr ? &own : nullptr;
      std::vector<Ray> rays(end - begin);
      for (size_t i = 0; i < rays.size(); ++i) rays[i] = make_ray(number(begin + i));
      if (!started_) {
        trace(rays, answers.subspan(begin, rays.size()), counters);
      } else {
        std::vector<Answer> found(rays.size());
        trace(rays, found, counters);
        for (size_t i = 0; i < rays.size(); ++i) answers[number(begin + i)] = found[i];
      }
      if (counters == nullptr) return;
      const std::lock_guard lock(mutex);
      counters_->add(own);
    });
  }

 private:
  size_t left() const { return started_ ? numbers_.size() : count_; }
  size_t number(size_t i) const { return started_ ? numbers_[i] : i; }

  void count(const Coverage& coverage, uint64_t answered) {
    if (counters_ == nullptr) return;
    counters_->rays += answered;
    counters_->covered += answered;
    counters_->areas[static_cast<size_t>(&coverage - coverages_.data())].covered += answered;
  }

  size_t count_;
  std::span<const Coverage> coverages_;
  AcceleratorCounters* counters_;
  bool started_ = false;
  std::vector<uint32_t> numbers_;
};

std::vector<const Coverage*> about(std::span<const Coverage> coverages, Vec3 eye) {
  std::vector<const Coverage*> found;
  for (const Coverage& coverage : coverages)
    if (coverage.has_eye(eye) && found.size() < 254) found.push_back(&coverage);
  return found;
}

}  // namespace

void Accelerator::occluded(std::span<const Vec3> origins, Vec3 direction, std::span<uint8_t> flags, unsigned threads,
                           AcceleratorCounters* counters) const {
  check_sizes("Accelerator", origins.size(), flags.size());
  Waiting waiting(origins.size(), coverages(), counters);
  const auto ask = [&](const Coverage& coverage, std::span<const uint32_t> numbers, std::vector<uint32_t>& rest) {
    coverage.occluded(origins, direction, flags, rest, numbers, threads);
  };
  for (const Coverage& coverage : coverages()) {
    if (waiting.is_empty()) return;
    if (coverage.sense(direction) == 1) waiting.offer(coverage, ask);
  }
  waiting.trace_rest(
      flags, threads,
      [&](size_t i) {
        return Ray{origins[i], direction, 0, kInf};
      },
      [&](std::span<const Ray> rays, std::span<uint8_t> found, AcceleratorCounters* count) {
        occluded(rays, found, 1, count);
      });
}

void Accelerator::intersect(std::span<const Vec3> origins, Vec3 direction, std::span<Hit> hits, unsigned threads,
                            AcceleratorCounters* counters) const {
  check_sizes("Accelerator", origins.size(), hits.size());
  Waiting waiting(origins.size(), coverages(), counters);
  const auto ask = [&](const Coverage& coverage, std::span<const uint32_t> numbers, std::vector<uint32_t>& rest) {
    coverage.intersect(origins, direction, hits, rest, numbers, threads);
  };
  for (const Coverage& coverage : coverages()) {
    if (waiting.is_empty()) return;
    if (coverage.sense(direction) == -1) waiting.offer(coverage, ask);
  }
  waiting.trace_rest(
      hits, threads,
      [&](size_t i) {
        return Ray{origins[i], direction, 0, kInf};
      },
      [&](std::span<const Ray> rays, std::span<Hit> found, AcceleratorCounters* count) {
        intersect(rays, found, 1, count);
      });
}

void Accelerator::occluded_towards(std::span<const Vec3> origins, Vec3 point, std::span<uint8_t> flags,
                                   unsigned threads, AcceleratorCounters* counters) const {
  check_sizes("Accelerator", origins.size(), flags.size());
  Waiting waiting(origins.size(), this->coverages(), counters);
  const std::vector<const Coverage*> coverages = about(this->coverages(), point);
  const auto ask = [&](const Coverage& coverage, std::span<const uint32_t> numbers, std::vector<uint32_t>& rest) {
    coverage.occluded_towards(origins, point, flags, rest, numbers, threads);
  };
  if (coverages.size() > 1)
    waiting.divide(coverages, origins, false, threads, ask);
  else if (coverages.size() == 1)
    waiting.offer(*coverages[0], ask);
  waiting.trace_rest(
      flags, threads,
      [&](size_t i) {
        return Ray{origins[i], point - origins[i], 0, 1};
      },
      [&](std::span<const Ray> rays, std::span<uint8_t> found, AcceleratorCounters* count) {
        occluded(rays, found, 1, count);
      });
}

void Accelerator::intersect_from(Vec3 eye, std::span<const Vec3> directions, std::span<Hit> hits, unsigned threads,
                                 AcceleratorCounters* counters) const {
  check_sizes("Accelerator", directions.size(), hits.size());
  Waiting waiting(directions.size(), this->coverages(), counters);
  const std::vector<const Coverage*> coverages = about(this->coverages(), eye);
  const auto ask = [&](const Coverage& coverage, std::span<const uint32_t> numbers, std::vector<uint32_t>& rest) {
    coverage.intersect_from(eye, directions, hits, rest, numbers, threads);
  };
  if (coverages.size() > 1)
    waiting.divide(coverages, directions, true, threads, ask);
  else if (coverages.size() == 1)
    waiting.offer(*coverages[0], ask);
  waiting.trace_rest(
      hits, threads,
      [&](size_t i) {
        return Ray{eye, directions[i], 0, kInf};
      },
      [&](std::span<const Ray> rays, std::span<Hit> found, AcceleratorCounters* count) {
        intersect(rays, found, 1, count);
      });
}

}  // namespace raygrain
