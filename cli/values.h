// Values on the command line as text. All failures are Error (kUsage) that names the option.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "raygrain/error.h"
#include "raygrain/vec.h"

#include "cli/arguments.h"

namespace raygrain::cli {

[[noreturn]] void fail_usage(const std::string& where, const std::string& what, const std::string& hint);

/// What make() returns. Its errors of this kind are about the option's value, which is the user's words: they become
/// errors of usage and carry the option's name.
template <class Make>
auto from_option(const std::string& option, ErrorCode code, const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    if (error.code != code) throw;
    throw Error(ErrorCode::kUsage, option, error.message, error.hint);
  }
}

uint64_t parse_whole(const std::string& option, std::string_view text, const Arguments::Limits& limits);
/// Strictly between: the ends themselves are refused, as are infinity and NaN.
float parse_real_between(const std::string& option, std::string_view text, float lo, float hi);
/// Three finite numbers "X,Y,Z". `example`: for messages.
Vec3 parse_vector(const std::string& option, std::string_view text, const std::string& example);

}  // namespace raygrain::cli
