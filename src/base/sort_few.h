// A stable sort for lists that are short nearly always.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace raygrain {

/// What is_before tells apart in no way keeps its order.
template <class Item, class IsBefore>
void sort_few(std::span<Item> items, const IsBefore& is_before) {
  constexpr size_t kFew = 24;
  if (items.size() > kFew) return std::stable_sort(items.begin(), items.end(), is_before);
  for (size_t i = 1; i < items.size(); ++i) {
    const Item item = items[i];
    size_t at = i;
    for (; at > 0 && is_before(item, items[at - 1]); --at) items[at] = items[at - 1];
    items[at] = item;
  }
}

}  // namespace raygrain
