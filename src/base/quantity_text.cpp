#include "base/quantity_text.h"

#include <charconv>
#include <cmath>

namespace raygrain {

namespace {

/// With a point, whatever the host program's locale says.
std::string decimal(double value, int digits) {
  char buffer[512];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, digits).ptr};
}

}  // namespace

std::string bytes_text(double bytes) {
  constexpr double kKibi = 1024;
  if (bytes < kKibi) return decimal(bytes, 0) + " B";
  if (bytes < kKibi * kKibi) return decimal(bytes / kKibi, 1) + " KiB";
  return decimal(bytes / (kKibi * kKibi), 1) + " MiB";
}

std::string rough_count_text(double count) {
  double unit = 1;
  while (std::isfinite(count) && count >= 100 * unit) unit *= 10;
  const double rounded = unit > 1 ? std::round(count / unit) * unit : std::ceil(count);
  const std::string digits = decimal(rounded, 0);
  std::string text;
  for (size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

}  // namespace raygrain
