// Parallel loops. oneTBB behind it, or std::thread (RAYGRAIN_STD_THREADS) where a sanitizer must see every
// synchronisation.
#pragma once

#include <cstddef>
#include <functional>

namespace raygrain {

/// Threads that `threads` = 0 stands for.
unsigned default_threads();

/// Calls body(begin, end) for consecutive chunks of [0, count) of `grain` items (the last may be smaller), on up to
/// `threads` threads (0 = all). Chunk borders depend on `count` and `grain` only, never on the threads. The first
/// exception of a body is rethrown here.
void parallel_for(size_t count, size_t grain, unsigned threads,
                  const std::function<void(size_t begin, size_t end)>& body);

}  // namespace raygrain
