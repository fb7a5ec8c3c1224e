#include "base/buffer.h"

#include <cstdlib>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace raygrain::detail {

namespace {
constexpr size_t kHugePage = size_t{1} << 21, kCacheLine = 64;
}

void FreeBytes::operator()(std::byte* bytes) const {
  std::free(bytes);
}

std::unique_ptr<std::byte, FreeBytes> allocate_bytes(size_t bytes) {
  if (bytes == 0) return {};
  const size_t alignment = bytes >= 2 * kHugePage ? kHugePage : kCacheLine;
  const size_t rounded = (bytes + alignment - 1) / alignment * alignment;
  std::unique_ptr<std::byte, FreeBytes> memory(static_cast<std::byte*>(std::aligned_alloc(alignment, rounded)));
  if (!memory) throw std::bad_alloc();
#ifdef __linux__
  if (alignment == kHugePage) madvise(memory.get(), rounded, MADV_HUGEPAGE);  // a wish: without it all is only slower
#endif
  return memory;
}

}  // namespace raygrain::detail
