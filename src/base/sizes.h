// What every call on arrays asks of its caller.
#pragma once

#include <cstddef>
#include <string>

#include "raygrain/error.h"

namespace raygrain {

/// Throws Error (kUsage) unless there is room for exactly one answer per ray.
inline void check_sizes(const char* where, size_t rays, size_t answers) {
  if (rays != answers)
    throw Error(ErrorCode::kUsage, where,
                std::to_string(rays) + " rays and room for " + std::to_string(answers) + " answers");
}

}  // namespace raygrain
