#include <cstdlib>
#include <cstring>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

#include "trace/wide_tree.h"

namespace raygrain {

namespace {
constexpr size_t kHugePage = size_t{1} << 21;
}

LineMemory::LineMemory(size_t bytes) : size_(bytes) {
  if (bytes == 0) return;
  const size_t alignment = bytes >= kHugePage ? kHugePage : 256;
  const size_t rounded = (bytes + alignment - 1) / alignment * alignment;
  bytes_.reset(static_cast<std::byte*>(std::aligned_alloc(alignment, rounded)));
  if (!bytes_) throw std::bad_alloc();
  if (bytes >= kCacheLine) std::memset(bytes_.get() + bytes - kCacheLine, 0, kCacheLine);
#ifdef __linux__
  if (alignment == kHugePage) madvise(bytes_.get(), rounded, MADV_HUGEPAGE);  // a wish: without it all is only slower
#endif
}

void LineMemory::Free::operator()(std::byte* bytes) const {
  std::free(bytes);
}

}  // namespace raygrain
