#include "base/parallel.h"

#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace raygrain {
namespace {

using Chunks = std::set<std::pair<size_t, size_t>>;

Chunks chunks_of(size_t count, size_t grain, unsigned threads) {
  Chunks chunks;
  std::mutex mutex;
  parallel_for(count, grain, threads, [&](size_t begin, size_t end) {
    const std::lock_guard lock(mutex);
    chunks.insert({begin, end});
  });
  return chunks;
}

TEST(Parallel, VisitsEveryItemOnce) {
  for (const size_t count : {0u, 1u, 7u, 1000u, 4096u})
    for (const size_t grain : {0u, 1u, 3u, 1000u, 5000u})
      for (const unsigned threads : {0u, 1u, 2u, 8u}) {
        SCOPED_TRACE(::testing::Message() << count << " items, grain " << grain << ", threads " << threads);
        std::vector<std::atomic<int>> visits(count);
        parallel_for(count, grain, threads, [&](size_t begin, size_t end) {
          for (size_t i = begin; i < end; ++i) ++visits[i];
        });
        for (const auto& visit : visits) ASSERT_EQ(visit, 1);
      }
}

TEST(Parallel, ChunksDoNotDependOnTheThreads) {
  const Chunks one = chunks_of(1003, 10, 1);
  EXPECT_EQ(one.size(), 101u);
  EXPECT_TRUE(one.contains({1000, 1003}));
  for (const unsigned threads : {0u, 2u, 8u}) EXPECT_EQ(chunks_of(1003, 10, threads), one);
}

TEST(Parallel, RethrowsWhatABodyThrows) {
  for (const unsigned threads : {1u, 2u, 8u})
    EXPECT_THROW(parallel_for(1000, 1, threads,
                              [](size_t begin, size_t) {
                                if (begin == 500) throw std::runtime_error("stop");
                              }),
                 std::runtime_error);
}

/// Builds run side by side: what one throws must leave the loops of the others whole.
TEST(Parallel, AFailureBesideDoesNotCutALoop) {
  for (const unsigned threads : {0u, 2u, 8u})
    for (int round = 0; round < 20; ++round) {
      std::atomic<int> begun{0}, short_loops{0};
      const auto body = [&](size_t begin, size_t) {
        ++begun;
        if (begin == 1) throw std::runtime_error("stop");
        std::atomic<int> done{0};
        parallel_for(64, 1, threads, [&](size_t, size_t) {
          std::this_thread::sleep_for(std::chrono::microseconds(20));
          ++done;
        });
        if (done != 64) ++short_loops;
      };
      EXPECT_THROW(parallel_for(8, 1, threads, body), std::runtime_error);
      ASSERT_EQ(short_loops, 0) << threads << " threads";
    }
}

/// A caller may hold a lock while a loop within runs.
TEST(Parallel, WhoWaitsForALoopDoesNothingElse) {
  thread_local int depth = 0;
  std::atomic<int> nested{0};
  for (const unsigned threads : {0u, 2u, 8u})
    parallel_for(40, 1, threads, [&](size_t, size_t) {
      if (depth++ > 0) ++nested;
      parallel_for(8, 1, threads, [&](size_t, size_t) { std::this_thread::yield(); });
      --depth;
    });
  EXPECT_EQ(nested, 0);
}

TEST(Parallel, LoopsMayNest) {
  std::atomic<int> sum{0};
  parallel_for(8, 1, 2, [&](size_t, size_t) {
    parallel_for(100, 7, 2, [&](size_t b, size_t e) { sum += static_cast<int>(e - b); });
  });
  EXPECT_EQ(sum, 800);
}

}  // namespace
}  // namespace raygrain
