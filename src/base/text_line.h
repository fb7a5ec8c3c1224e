// Formatted text as a string, by the rules of printf.
#pragma once

#include <cstdio>
#include <string>

namespace raygrain {

/// At most 399 characters.
template <class... Values>
std::string text_line(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace raygrain
