#include "base/check.h"

#ifdef RAYGRAIN_CHECKS
#include <cstdio>
#include <cstdlib>

namespace raygrain::detail {

void check_failed(const char* file, int line, const char* expression, const char* values) {
  std::fprintf(stderr, "%s:%d: check failed: %s (%s)\n", file, line, expression, values);
  std::abort();
}

}  // namespace raygrain::detail
#endif
