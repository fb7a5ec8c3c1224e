#include "io/nearest_name.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace raygrain {
namespace {

size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string_view nearest_name(std::string_view word, std::span<const std::string_view> names) {
  constexpr size_t kLongestWord = 64;  // longer ones are no typing mistakes
  if (word.size() > kLongestWord) return {};
  std::string_view best;
  size_t best_distance = kLongestWord;
  for (const std::string_view name : names) {
    const size_t distance = edit_distance(word, name);
    if (distance >= best_distance || 2 * distance > std::max(word.size(), name.size())) continue;
    best = name;
    best_distance = distance;
  }
  return best;
}

std::string suggestion(std::string_view word, std::span<const std::string_view> names) {
  const std::string_view near = nearest_name(word, names);
  if (!near.empty()) return "Did you mean \"" + std::string(near) + "\"?";
  std::string list = "Known: ";
  for (size_t i = 0; i < names.size(); ++i) list.append(i == 0 ? "" : ", ").append(names[i]);
  return list;
}

}  // namespace raygrain
