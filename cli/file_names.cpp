#include "cli/file_names.h"

#include <algorithm>
#include <string_view>

namespace raygrain::cli {

namespace {

constexpr size_t kLongest = 100;

std::string safe_name(std::string name) {
  constexpr std::string_view kSafe = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789+-_.";
  for (char& c : name)
    if (kSafe.find(c) == std::string_view::npos) c = '_';
  if (name.empty()) name = "area";
  if (name[0] == '.' || name[0] == '-') name[0] = '_';
  return name.substr(0, kLongest);
}

}  // namespace

std::vector<std::string> file_names(std::span<const std::string> areas) {
  std::vector<std::string> names;
  for (const std::string& area : areas) {
    const std::string stem = safe_name(area);
    std::string name = stem;
    for (int number = 2; std::find(names.begin(), names.end(), name) != names.end(); ++number)
      name = stem + "_" + std::to_string(number);
    names.push_back(name);
  }
  return names;
}

}  // namespace raygrain::cli
