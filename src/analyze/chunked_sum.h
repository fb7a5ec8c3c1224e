// Sums over many rays that do not depend on the number of threads.
#pragma once

#include <cstddef>
#include <vector>

#include "base/parallel.h"

namespace raygrain {

/// Adds up `per_item(index, sum)` over [0, count): each chunk into a Sum of its own, the chunks in their order.
/// Sum needs a default of zero and add(const Sum&).
template <class Sum, class PerItem>
Sum chunked_sum(size_t count, unsigned threads, const PerItem& per_item) {
  constexpr size_t kGrain = 128;
  std::vector<Sum> chunks((count + kGrain - 1) / kGrain);
  parallel_for(count, kGrain, threads, [&](size_t begin, size_t end) {
    Sum sum;
    for (size_t i = begin; i < end; ++i) per_item(i, sum);
    chunks[begin / kGrain] = sum;
  });
  Sum total;
  for (const Sum& chunk : chunks) total.add(chunk);
  return total;
}

}  // namespace raygrain
