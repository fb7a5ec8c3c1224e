#include "cli/asked_rays.h"

#include <algorithm>
#include <mutex>

#include "raygrain/compare.h"

#include "base/parallel.h"
#include "base/timer.h"
#include "geometry/same_bits.h"

namespace raygrain::cli {

namespace {

constexpr size_t kPiece = 65536;  // of rays that are asked together: large, for between them progress is told

using raygrain::same_bits;
bool same_bits(uint8_t flag, const Hit& hit) {
  return flag == (is_hit(hit) ? 1 : 0);
}

void ask_together(const Accelerator& accelerator, std::span<const Ray> rays, std::span<Hit> hits, unsigned threads,
                  AcceleratorCounters* counters) {
  accelerator.intersect(rays, hits, threads, counters);
}
void ask_together(const Accelerator& accelerator, std::span<const Ray> rays, std::span<uint8_t> flags, unsigned threads,
                  AcceleratorCounters* counters) {
  accelerator.occluded(rays, flags, threads, counters);
}

void ask_one(const Accelerator& accelerator, const Ray& ray, Hit& hit, AcceleratorCounters* counters) {
  hit = accelerator.intersect(ray, counters);
}
void ask_one(const Accelerator& accelerator, const Ray& ray, uint8_t& flag, AcceleratorCounters* counters) {
  flag = accelerator.occluded(ray, counters) ? 1 : 0;
}

template <class Answer>
void ask_one_by_one(const Accelerator& accelerator, std::span<const Ray> rays, std::span<Answer> answers,
                    unsigned threads, AcceleratorCounters* counters) {
  std::mutex mutex;
  parallel_for(rays.size(), 1024, threads, [&](size_t begin, size_t end) {
    AcceleratorCounters own;
    for (size_t i = begin; i < end; ++i)
      ask_one(accelerator, rays[i], answers[i], counters != nullptr ? &own : nullptr);
    if (counters == nullptr) return;
    const std::lock_guard lock(mutex);
    counters->add(own);
  });
}

/// Some rays with what brute force says about them.
struct Piece {
  std::span<const Ray> rays;
  std::vector<Hit> right;
  std::vector<uint8_t> wrong;  // 1: some answer was

  template <class Answer>
  void compare(std::span<const Answer> answers, std::vector<uint8_t>& differs) const {
    for (size_t i = 0; i < rays.size(); ++i)
      if (!same_bits(answers[i], right[i])) differs[i] = 1;
  }
};

/// Brute force is slow: `tell` hears of every few rays.
Piece search_by_brute_force(const TriangleMesh& mesh, std::span<const Ray> rays, unsigned threads, const Tell& tell) {
  constexpr size_t kFew = 256;
  Piece piece{rays, std::vector<Hit>(rays.size()), std::vector<uint8_t>(rays.size())};
  for (size_t start = 0; start < rays.size(); start += kFew) {
    tell(static_cast<double>(start) / static_cast<double>(rays.size()));
    parallel_for(std::min(kFew, rays.size() - start), 8, threads, [&](size_t begin, size_t end) {
      for (size_t i = start + begin; i < start + end; ++i) piece.right[i] = intersect_reference(mesh, rays[i]);
    });
  }
  return piece;
}

template <class Answer>
void check(const Accelerator& accelerator, unsigned threads, CheckedQuestion& checked, Piece& piece) {
  std::vector<uint8_t> differs(piece.rays.size());
  for (AcceleratorCounters* counters : {&checked.counters, static_cast<AcceleratorCounters*>(nullptr)}) {
    std::vector<Answer> answers(piece.rays.size());
    if (checked.question.together)
      ask_together(accelerator, piece.rays, std::span(answers), threads, counters);
    else
      ask_one_by_one(accelerator, piece.rays, std::span(answers), threads, counters);
    piece.compare(std::span<const Answer>(answers), differs);
  }
  for (size_t i = 0; i < differs.size(); ++i) {
    checked.differences += differs[i];
    piece.wrong[i] |= differs[i];
  }
}

}  // namespace

size_t RayAnswers::hit_count() const {
  return static_cast<size_t>(std::ranges::count_if(hits, is_hit) + std::ranges::count(flags, 1));
}

RayAnswers ask_rays(const Accelerator& accelerator, std::span<const Ray> rays, bool any, unsigned threads,
                    const Tell& tell) {
  RayAnswers answers;
  answers.hits.resize(any ? 0 : rays.size());
  answers.flags.resize(any ? rays.size() : 0);
  const Timer timer;
  for (size_t start = 0; start < rays.size(); start += kPiece) {
    tell(static_cast<double>(start) / static_cast<double>(rays.size()));
    const std::span<const Ray> some = rays.subspan(start, std::min(kPiece, rays.size() - start));
    if (any)
      ask_together(accelerator, some, std::span(answers.flags).subspan(start, some.size()), threads, &answers.counters);
    else
      ask_together(accelerator, some, std::span(answers.hits).subspan(start, some.size()), threads, &answers.counters);
  }
  answers.seconds = timer.seconds();
  return answers;
}

CheckedAnswers check_answers(const Accelerator& accelerator, std::span<const Ray> rays, const RayAnswers& given,
                             unsigned threads, const Tell& tell) {
  CheckedAnswers result;
  for (size_t start = 0; start < rays.size(); start += kPiece) {
    const size_t count = std::min(kPiece, rays.size() - start);
    Piece piece = search_by_brute_force(accelerator.mesh(), rays.subspan(start, count), threads, [&](double done) {
      tell((static_cast<double>(start) + done * static_cast<double>(count)) / static_cast<double>(rays.size()));
    });
    for (CheckedQuestion& checked : result.questions)
      checked.question.any ? check<uint8_t>(accelerator, threads, checked, piece)
                           : check<Hit>(accelerator, threads, checked, piece);
    if (!given.hits.empty()) piece.compare(std::span(given.hits).subspan(start, count), piece.wrong);
    if (!given.flags.empty()) piece.compare(std::span(given.flags).subspan(start, count), piece.wrong);
    result.wrong += static_cast<uint64_t>(std::ranges::count(piece.wrong, 1));
  }
  return result;
}

}  // namespace raygrain::cli
