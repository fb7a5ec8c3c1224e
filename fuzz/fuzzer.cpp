// A target as a libFuzzer program.
#include <cstdlib>

#include "targets.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  raygrain::fuzz::RAYGRAIN_FUZZ_TARGET({data, size});  // an exception is libFuzzer's finding
  return 0;
}
