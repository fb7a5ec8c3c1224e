// Builds that are cancelled at any moment: an error and nothing else, and the next build is as ever.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>

#include "raygrain/error.h"
#include "raygrain/refine.h"
#include "raygrain/registry.h"

#include "build/build_support.h"
#include "support/mesh_families.h"

namespace raygrain::test {
namespace {

/// Primitives enough for several progress calls of every builder.
const Prims& prims() {
  static const Prims all = random_prims(30000, 5);
  return all;
}

Bvh build(const BuilderEntry& builder, const BuildOptions& options) {
  return builder.build(prims().bounds, prims().centroids, options, nullptr);
}

BuildOptions options_for(unsigned threads) {
  BuildOptions options;
  options.threads = threads;
  options.clip = [](uint32_t i, const Bounds& box) { return intersected(prims().bounds[i], box); };
  return options;
}

/// Runs the build with a progress function; did it end as cancelled?
template <class Progress>
bool is_cancelled(const BuilderEntry& builder, unsigned threads, const Progress& progress) {
  BuildOptions options = options_for(threads);
  options.progress = progress;
  try {
    build(builder, options);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::kCancelled) << error.what();
    return true;
  }
  return false;
}

TEST(Cancel, AtAnyProgressCallOfEveryBuilder) {
  for (const BuilderEntry& builder : default_registry().builders)
    for (const unsigned threads : {1u, 3u}) {
      SCOPED_TRACE(builder.name + ", " + std::to_string(threads) + " threads");
      const Bvh before = build(builder, options_for(threads));
      size_t calls = 0;
      ASSERT_FALSE(is_cancelled(builder, threads, [&](double) { return ++calls > 0; }));
      ASSERT_GE(calls, 2u);
      Random random(calls);
      for (uint64_t round = 0; round < seed_count(4); ++round) {
        // The number of calls may vary with the threads' pace: the first ones always come.
        const size_t stop = round == 0 ? 1 : 1 + random.below(std::max<size_t>(calls / 2, 1));
        size_t told = 0;
        ASSERT_TRUE(is_cancelled(builder, threads, [&](double) { return ++told < stop; })) << stop << " of " << calls;
        ASSERT_EQ(told, stop) << "called again after it said no";
      }
      ASSERT_TRUE(same_tree(before, build(builder, options_for(threads))));
    }
}

TEST(Cancel, FromAnotherThreadAtARandomMoment) {
  Random random(9);
  size_t cancelled = 0;
  for (const BuilderEntry& builder : default_registry().builders)
    for (uint64_t round = 0; round < seed_count(4); ++round) {
      SCOPED_TRACE(builder.name + ", round " + std::to_string(round));
      std::atomic<bool> wanted = true;
      const auto delay = std::chrono::microseconds(random.below(20000));
      std::jthread canceller([&wanted, delay] {
        std::this_thread::sleep_for(delay);
        wanted = false;
      });
      cancelled += is_cancelled(builder, 2, [&](double) { return wanted.load(); });
    }
  std::printf("%zu builds cancelled\n", cancelled);
}

TEST(Cancel, ReinsertionLeavesTheTreeAsItWas) {
  const Bvh before = binned(prims());
  for (const size_t stop : {size_t{1}, size_t{2}}) {
    Bvh tree = before;
    size_t told = 0;
    ReinsertOptions options;
    options.progress = [&](double) { return ++told < stop; };
    try {
      reinsert(tree, {}, options);
      ADD_FAILURE() << "not cancelled";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kCancelled);
    }
    EXPECT_TRUE(same_tree(before, tree));
  }
}

}  // namespace
}  // namespace raygrain::test
