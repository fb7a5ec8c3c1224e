// How much memory is left for this process.
#pragma once

#include <cstdint>

namespace raygrain {

/// Bytes that this process may still take: the least of what the machine has free or can free (swap included), what its
/// control groups leave, and what its limits (ulimit -v, ulimit -d) leave. UINT64_MAX where nothing can be read. The
/// environment variable RAYGRAIN_MEMORY, in MiB, replaces all of it.
uint64_t available_memory();

}  // namespace raygrain
