// Values on the command line as text. All failures are Error (kUsage) that names the option.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "raygrain/vec.h"

namespace raygrain::cli {

[[noreturn]] void fail_usage(const std::string& where, const std::string& what, const std::string& hint);

uint64_t parse_whole(const std::string& option, std::string_view text, uint64_t lo, uint64_t hi);
/// Strictly between: the ends themselves are refused, as are infinity and NaN.
float parse_real_between(const std::string& option, std::string_view text, float lo, float hi);
/// Three finite numbers "X,Y,Z".
Vec3 parse_vector(const std::string& option, std::string_view text);

}  // namespace raygrain::cli
