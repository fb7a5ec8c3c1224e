#include "base/nearest_name.h"

#include <algorithm>
#include <vector>

namespace raygrain {
namespace {

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// A swap of neighbours counts once: it is the commonest slip in names like SPFH.
size_t edit_distance(std::string_view a, std::string_view b) {
  const size_t width = b.size() + 1;
  const auto same = [&](size_t i, size_t j) { return lower(a[i - 1]) == lower(b[j - 1]); };
  std::vector<size_t> table((a.size() + 1) * width);
  for (size_t i = 0; i <= a.size(); ++i)
    for (size_t j = 0; j <= b.size(); ++j) {
      size_t& least = table[i * width + j];
      if (i == 0 || j == 0) {
        least = i + j;
        continue;
      }
      const size_t above = (i - 1) * width + j, left = i * width + j - 1;
      least = std::min({table[above] + 1, table[left] + 1, table[above - 1] + (same(i, j) ? 0 : 1)});
      if (i > 1 && j > 1 && same(i, j - 1) && same(i - 1, j))
        least = std::min(least, table[(i - 2) * width + j - 2] + 1);
    }
  return table.back();
}

}  // namespace

std::string_view nearest_name(std::string_view word, std::span<const std::string_view> names) {
  constexpr size_t kLongestWord = 64;  // longer ones are no typing mistakes
  if (word.size() > kLongestWord) return {};
  std::string_view best;
  size_t best_distance = kLongestWord;
  for (const std::string_view name : names) {
    const size_t distance = edit_distance(word, name);
    if (distance >= best_distance || 3 * distance > std::max(word.size(), name.size())) continue;
    best = name;
    best_distance = distance;
  }
  return best;
}

std::string known_names(std::span<const std::string_view> names) {
  std::string list = "Known: ";
  for (size_t i = 0; i < names.size(); ++i) list.append(i == 0 ? "" : ", ").append(names[i]);
  return list;
}

std::string suggestion(std::string_view word, std::span<const std::string_view> names) {
  const std::string_view near = nearest_name(word, names);
  return near.empty() ? known_names(names) : "Did you mean \"" + std::string(near) + "\"?";
}

}  // namespace raygrain
