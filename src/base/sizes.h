// What calls on arrays ask of their caller.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "raygrain/error.h"

namespace raygrain {

/// Throws Error (kUsage) unless there is room for exactly one answer per ray.
inline void check_sizes(const char* where, size_t rays, size_t answers) {
  if (rays != answers)
    throw Error(ErrorCode::kUsage, where,
                std::to_string(rays) + " rays and room for " + std::to_string(answers) + " answers");
}

/// Throws Error (kUsage) unless all numbers are below `count`.
inline void check_numbers(const char* where, std::span<const uint32_t> numbers, size_t count, const char* things) {
  if (count > 0xffffffffu) return;  // every number is
  const auto end = static_cast<uint32_t>(count);
  uint32_t beyond = 0;  // all are compared, several at once
  for (const uint32_t number : numbers) beyond |= number >= end ? 1u : 0u;
  if (beyond != 0)
    throw Error(ErrorCode::kUsage, where,
                "names number " + std::to_string(*std::ranges::max_element(numbers)) + " of " + std::to_string(count) +
                    " " + things);
}

}  // namespace raygrain
