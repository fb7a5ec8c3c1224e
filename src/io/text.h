// Text files and the numbers in them: exact both ways, whatever the locale.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace raygrain {

/// The bytes of a file. Throws Error: kNotFound, kUnreadable (a folder, a device, no permission, a read
/// error).
std::string read_whole_file(const std::string& path);

/// The float nearest to a decimal number, "inf" or "nan"; nothing if the text is anything else, or too large.
std::optional<float> parse_float(std::string_view text);

/// A decimal number that is too large for parse_float.
bool is_beyond_float(std::string_view text);

/// The shortest text that parse_float turns back into the same float.
void append_float(std::string& text, float value);

constexpr bool is_blank(char symbol) {
  return symbol == ' ' || symbol == '\t' || symbol == '\r' || symbol == '\v' || symbol == '\f';
}
std::string_view trimmed(std::string_view text);

/// `text` made fit to be shown in a message: at most 40 bytes, control characters and broken bytes replaced.
std::string in_quotes(std::string_view text);

/// "file:line:column" or "file:line".
std::string place(const std::string& path, size_t line, size_t column = 0);

}  // namespace raygrain
