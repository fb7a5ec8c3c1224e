#include "base/quantity_text.h"

#include <cmath>

#include "base/text_line.h"

namespace raygrain {

std::string bytes_text(double bytes) {
  constexpr double kKibi = 1024;
  if (bytes < kKibi) return text_line("%.0f B", bytes);
  if (bytes < kKibi * kKibi) return text_line("%.1f KiB", bytes / kKibi);
  return text_line("%.1f MiB", bytes / (kKibi * kKibi));
}

std::string rough_count_text(double count) {
  double unit = 1;
  while (std::isfinite(count) && count >= 100 * unit) unit *= 10;
  const double rounded = unit > 1 ? std::round(count / unit) * unit : std::ceil(count);
  const std::string digits = text_line("%.0f", rounded);
  std::string text;
  for (size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

}  // namespace raygrain
