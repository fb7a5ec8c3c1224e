// Four floats as one value. A language extension that GCC and Clang share and compile for every machine: no
// instruction set is named here, and results are those of the four scalar operations.
#pragma once

#include <cstdint>

namespace raygrain {

using FourFloats = float __attribute__((vector_size(16)));
using FourInts = int32_t __attribute__((vector_size(16)));

inline FourFloats lesser(FourFloats a, FourFloats b) {
  return a < b ? a : b;
}

/// Towards zero.
inline FourInts truncated(FourFloats a) {
  return __builtin_convertvector(a, FourInts);
}

}  // namespace raygrain
