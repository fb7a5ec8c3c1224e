#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#ifndef RAYGRAIN_STD_THREADS
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#endif

namespace raygrain {

unsigned default_threads() {
  return std::max(1u, std::thread::hardware_concurrency());
}

namespace {

#ifdef RAYGRAIN_STD_THREADS
/// Workers take chunk numbers from one counter; the first exception stops the rest.
void run_chunks(size_t chunks, unsigned threads, const std::function<void(size_t)>& run) {
  std::atomic<size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    for (size_t chunk = next++; chunk < chunks; chunk = next++) {
      try {
        run(chunk);
      } catch (...) {
        const std::lock_guard lock(failure_mutex);
        if (!failure) failure = std::current_exception();
        next = chunks;
      }
    }
  };
  std::vector<std::jthread> workers;
  for (unsigned i = 1; i < threads; ++i) workers.emplace_back(work);
  work();
  workers.clear();
  if (failure) std::rethrow_exception(failure);
}
#else
void run_chunks(size_t chunks, unsigned threads, const std::function<void(size_t)>& run) {
  // More threads than processors help nobody, and oneTBB prints a warning about them.
  const auto wanted = static_cast<int>(std::min(threads, default_threads()));
  // Nobody else's failure cuts this loop short ...
  tbb::task_group_context alone(tbb::task_group_context::isolated);
  const auto loop = [&] { tbb::parallel_for(size_t{0}, chunks, run, alone); };
  // ... and who waits for it does nothing else: callers may hold locks. Workers come to a new arena late.
  if (tbb::this_task_arena::max_concurrency() == wanted) return tbb::this_task_arena::isolate(loop);
  tbb::task_arena(wanted).execute(loop);
}
#endif

}  // namespace

void parallel_for(size_t count, size_t grain, unsigned threads, const std::function<void(size_t, size_t)>& body) {
  if (count == 0) return;
  grain = std::max<size_t>(grain, 1);
  const size_t chunks = (count + grain - 1) / grain;
  const auto run = [&](size_t chunk) { body(chunk * grain, std::min(count, (chunk + 1) * grain)); };
  if (chunks == 1) return run(0);  // without asking the system for its number of processors
  if (threads == 0) threads = default_threads();
  threads = static_cast<unsigned>(std::min<size_t>(threads, chunks));
  if (threads > 1) return run_chunks(chunks, threads, run);
  for (size_t chunk = 0; chunk < chunks; ++chunk) run(chunk);
}

}  // namespace raygrain
