// A large array whose elements nobody initialises before they are written, on huge pages where the system has them.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>

namespace raygrain {

namespace detail {
struct FreeBytes {
  void operator()(std::byte* bytes) const;
};
/// Throws std::bad_alloc.
std::unique_ptr<std::byte, FreeBytes> allocate_bytes(size_t bytes);
}  // namespace detail

template <class Element>
class Buffer {
  static_assert(std::is_trivially_copyable_v<Element> && std::is_trivially_destructible_v<Element>);

 public:
  Buffer() = default;
  explicit Buffer(size_t size) : bytes_(detail::allocate_bytes(size * sizeof(Element))), size_(size) {}

  size_t size() const { return size_; }
  size_t bytes() const { return size_ * sizeof(Element); }
  /// Elements must be written before they are read.
  std::span<Element> elements() const { return {reinterpret_cast<Element*>(bytes_.get()), size_}; }

 private:
  std::unique_ptr<std::byte, detail::FreeBytes> bytes_;
  size_t size_ = 0;
};

}  // namespace raygrain
