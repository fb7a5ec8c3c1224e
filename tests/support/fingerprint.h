// One number for many bytes, to tell whether they are still what they were.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ranges>
#include <type_traits>

namespace raygrain::test {

/// Fowler, Noll and Vo's FNV-1a over the bytes of the values; values without padding.
template <std::ranges::contiguous_range... Ranges>
uint64_t fingerprint(const Ranges&... ranges) {
  uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&hash](const auto& range) {
    static_assert(std::is_trivially_copyable_v<std::ranges::range_value_t<decltype(range)>>);
    const auto* bytes = reinterpret_cast<const unsigned char*>(std::ranges::data(range));
    const size_t count = std::ranges::size(range) * sizeof(*std::ranges::data(range));
    for (size_t i = 0; i < count; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3u;
  };
  (add(ranges), ...);
  return hash;
}

}  // namespace raygrain::test
