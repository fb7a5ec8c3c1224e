#include "io/text.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "raygrain/error.h"

namespace raygrain {

namespace {

/// As from_chars, of all of the text; takes a plus away from before it.
std::errc read_whole(std::string_view& text, float& value) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
    if (text.starts_with('-')) return std::errc::invalid_argument;
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return end == text.data() + text.size() ? error : std::errc::invalid_argument;
}

/// Of a number: is it below one? Where its first digit but 0 stands, and the exponent, say so.
bool is_small(std::string_view text) {
  const size_t end = std::min(text.find_first_of("eE"), text.size());
  const std::string_view digits = text.substr(0, end);
  const size_t point = std::min(digits.find('.'), digits.size()), first = digits.find_first_of("123456789");
  if (first == std::string_view::npos) return true;
  const auto place = static_cast<int64_t>(point) - static_cast<int64_t>(first) - (first < point ? 1 : 0);
  std::string_view exponent = text.substr(std::min(end + 1, text.size()));
  const bool is_negative = exponent.starts_with('-');
  if (exponent.starts_with('+') || is_negative) exponent.remove_prefix(1);
  int64_t power = 0;
  if (std::from_chars(exponent.data(), exponent.data() + exponent.size(), power).ec == std::errc::result_out_of_range)
    return is_negative;
  power = std::min(power, int64_t{1} << 60);
  return place + (is_negative ? -power : power) < 0;
}

/// What is beyond float: too small is zero, too large is no number. Overflow and underflow look alike to from_chars.
std::optional<float> parse_extreme(std::string_view text) {
  double value = 0;
  if (std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc::result_out_of_range) {
    if (!is_small(text)) return std::nullopt;
    value = text.front() == '-' ? -0.0 : 0.0;
  }
  const float narrowed = static_cast<float>(value);
  if (narrowed - narrowed != 0) return std::nullopt;
  return narrowed;
}

[[noreturn]] void refuse(const std::string& path, int error) {
  if (error == ENOENT || error == ENOTDIR)
    throw Error(ErrorCode::kNotFound, path, "there is no such file", "check the name and the folder");
  throw Error(ErrorCode::kUnreadable, path, "cannot read: " + std::generic_category().message(error));
}

struct Descriptor {
  int number;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

}  // namespace

std::string read_whole_file(const std::string& path) {
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY)};
  if (file.number < 0) refuse(path, errno);
  struct stat status {};
  if (::fstat(file.number, &status) != 0) refuse(path, errno);
  if (S_ISDIR(status.st_mode)) refuse(path, EISDIR);
  if (S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode))  // /dev/zero has no end
    throw Error(ErrorCode::kUnreadable, path, "is a device, not a file", "give a file or a pipe");
  std::string bytes;
  size_t used = 0;
  bytes.resize(static_cast<size_t>(std::max<off_t>(status.st_size, 0)) + 1);
  for (;;) {
    if (used == bytes.size()) bytes.resize(bytes.size() * 2 + 4096);
    const ssize_t count = ::read(file.number, bytes.data() + used, bytes.size() - used);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse(path, errno);
    if (count == 0) break;
    used += static_cast<size_t>(count);
  }
  bytes.resize(used);
  return bytes;
}

std::optional<float> parse_float(std::string_view text) {
  float value = 0;
  const std::errc error = read_whole(text, value);
  if (error == std::errc::result_out_of_range) return parse_extreme(text);
  if (error != std::errc{}) return std::nullopt;
  return value;
}

bool is_beyond_float(std::string_view text) {
  float value = 0;
  return read_whole(text, value) == std::errc::result_out_of_range && !parse_extreme(text);
}

void append_float(std::string& text, float value) {
  char buffer[32];
  text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char symbol : text.substr(0, 40)) result += symbol >= ' ' && symbol <= '~' ? symbol : '?';
  return result + (text.size() > 40 ? "...\"" : "\"");
}

std::string place(const std::string& path, size_t line, size_t column) {
  std::string result = path + ":" + std::to_string(line);
  return column == 0 ? result : result + ":" + std::to_string(column);
}

}  // namespace raygrain
