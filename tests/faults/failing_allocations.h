// Memory that runs out on demand: this program's operator new, and aligned_alloc.
#pragma once

#include <cstddef>

namespace raygrain::test {

/// Lets the n-th allocation from now on fail (1: the next one), and all after it succeed; 0: none fails.
void fail_allocation(size_t n);

/// Allocations since fail_allocation was called last.
size_t allocations_since();

/// Blocks that are there now.
size_t live_blocks();

}  // namespace raygrain::test
