#include "cli/values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "raygrain/error.h"

#include "io/text.h"

namespace raygrain::cli {

namespace {

std::string_view without_spaces(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

/// Throws where the text is a number, but larger than any float.
std::optional<float> finite_number(const std::string& option, std::string_view text) {
  text = without_spaces(text);
  const std::optional<float> value = parse_float(text);
  if (!value && is_beyond_float(text))
    fail_usage(option, fmt::format("'{}' is beyond float32 (3.4e38)", text), "Give numbers between -3.4e38 and 3.4e38");
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace

void fail_usage(const std::string& where, const std::string& what, const std::string& hint) {
  throw Error(ErrorCode::kUsage, where, what, hint);
}

uint64_t parse_whole(const std::string& option, std::string_view text, const Arguments::Limits& limits) {
  const auto& [lo, hi, example] = limits;
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size() && lo <= value && value <= hi) return value;
  fail_usage(option, fmt::format("'{}' is not a whole number from {} to {}", text, lo, hi),
             fmt::format("Give digits only, e.g. {} {}", option, std::clamp(example, lo, hi)));
}

float parse_real_between(const std::string& option, std::string_view text, float lo, float hi) {
  const std::optional<float> value = finite_number(option, text);
  if (value && *value > lo && *value < hi) return *value;
  fail_usage(option, fmt::format("'{}' is not a number between {} and {}", text, lo, hi),
             "Both ends are excluded; write decimals with a point");
}

Vec3 parse_vector(const std::string& option, std::string_view text, const std::string& example) {
  Vec3 result;
  std::string_view rest = text;
  for (int axis = 0; axis < 3; ++axis) {
    const size_t comma = axis < 2 ? rest.find(',') : rest.size();
    const std::optional<float> value =
        comma == std::string_view::npos ? std::nullopt : finite_number(option, rest.substr(0, comma));
    if (!value)
      fail_usage(option, fmt::format("'{}' is not three numbers X,Y,Z", text),
                 fmt::format("Separate them by commas without spaces, e.g. {} {}", option, example));
    result[axis] = *value;
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return result;
}

}  // namespace raygrain::cli
