#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

#include "trace/wide_tree.h"

namespace raygrain {

namespace {

constexpr size_t kHugePage = size_t{1} << 21, kPage = size_t{1} << 12;

size_t round_up(size_t bytes, size_t unit) {
  return (bytes + unit - 1) / unit * unit;
}

#ifdef __linux__
/// Fresh memory from the start of a huge page on: the heap hands out what has small pages already, and wishes come too
/// late for that. Null where there is none.
std::byte* map_huge_pages(size_t bytes) {
  const size_t length = bytes + kHugePage;
  void* mapping = mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapping == MAP_FAILED) return nullptr;
  auto* first = static_cast<std::byte*>(mapping);
  const auto address = reinterpret_cast<uintptr_t>(mapping);
  const size_t before = round_up(address, kHugePage) - address, after = length - before - bytes;
  if (before > 0) munmap(first, before);
  if (after > 0) munmap(first + before + bytes, after);
  madvise(first + before, bytes, MADV_HUGEPAGE);  // a wish: without it all is only slower
  return first + before;
}
#endif

}  // namespace

LineMemory::LineMemory(size_t bytes) : size_(bytes) {
  if (bytes == 0) return;
#ifdef __linux__
  const size_t mapped = round_up(bytes, kPage);
  if (bytes >= kHugePage) bytes_ = {map_huge_pages(mapped), FreeLines{mapped}};
#endif
  constexpr size_t kAlignment = 256;
  if (!bytes_)
    bytes_ = {static_cast<std::byte*>(std::aligned_alloc(kAlignment, round_up(bytes, kAlignment))), FreeLines{}};
  if (!bytes_) throw std::bad_alloc();
  if (bytes >= kCacheLine) std::memset(bytes_.get() + bytes - kCacheLine, 0, kCacheLine);
}

void FreeLines::operator()(std::byte* bytes) const {
#ifdef __linux__
  if (mapped > 0) return void(munmap(bytes, mapped));
#endif
  std::free(bytes);
}

}  // namespace raygrain
