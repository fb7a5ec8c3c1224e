#include "base/parallel.h"

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
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

TEST(Parallel, LoopsMayNest) {
  std::atomic<int> sum{0};
  parallel_for(8, 1, 2, [&](size_t, size_t) {
    parallel_for(100, 7, 2, [&](size_t b, size_t e) { sum += static_cast<int>(e - b); });
  });
  EXPECT_EQ(sum, 800);
}

}  // namespace
}  // namespace raygrain
