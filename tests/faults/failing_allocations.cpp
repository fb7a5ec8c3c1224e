#include "faults/failing_allocations.h"

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace raygrain::test {

namespace {

std::atomic<size_t> failing = 0, count = 0;
std::atomic<int64_t> live = 0;

bool fails() {
  return ++count == failing;
}

void* counted(void* block) {
  if (block != nullptr) ++live;
  return block;
}

void* allocate(size_t bytes) {
  return fails() ? nullptr : counted(std::malloc(bytes == 0 ? 1 : bytes));
}

void* allocate(size_t bytes, std::align_val_t alignment) {
  void* block = nullptr;
  if (fails() || ::posix_memalign(&block, static_cast<size_t>(alignment), bytes == 0 ? 1 : bytes) != 0) return nullptr;
  return counted(block);
}

template <class... Alignment>
void* allocate_or_throw(size_t bytes, Alignment... alignment) {
  void* const block = allocate(bytes, alignment...);
  if (block == nullptr) throw std::bad_alloc();
  return block;
}

void release(void* block) noexcept {
  if (block != nullptr) --live;
  std::free(block);
}

}  // namespace

void fail_allocation(size_t n) {
  count = 0;
  failing = n;
}

size_t allocations_since() {
  return count;
}

size_t live_blocks() {
  return static_cast<size_t>(live);
}

}  // namespace raygrain::test

using raygrain::test::allocate;
using raygrain::test::allocate_or_throw;
using raygrain::test::release;

void* operator new(size_t bytes) {
  return allocate_or_throw(bytes);
}
void* operator new[](size_t bytes) {
  return allocate_or_throw(bytes);
}
void* operator new(size_t bytes, std::align_val_t alignment) {
  return allocate_or_throw(bytes, alignment);
}
void* operator new[](size_t bytes, std::align_val_t alignment) {
  return allocate_or_throw(bytes, alignment);
}
void* operator new(size_t bytes, const std::nothrow_t&) noexcept {
  return allocate(bytes);
}
void* operator new[](size_t bytes, const std::nothrow_t&) noexcept {
  return allocate(bytes);
}
void operator delete(void* block) noexcept {
  release(block);
}
void operator delete[](void* block) noexcept {
  release(block);
}
void operator delete(void* block, size_t) noexcept {
  release(block);
}
void operator delete[](void* block, size_t) noexcept {
  release(block);
}
void operator delete(void* block, std::align_val_t) noexcept {
  release(block);
}
void operator delete[](void* block, std::align_val_t) noexcept {
  release(block);
}
void operator delete(void* block, size_t, std::align_val_t) noexcept {
  release(block);
}
void operator delete[](void* block, size_t, std::align_val_t) noexcept {
  release(block);
}
void operator delete(void* block, const std::nothrow_t&) noexcept {
  release(block);
}
void operator delete[](void* block, const std::nothrow_t&) noexcept {
  release(block);
}

/// What large arrays of the library are made of; they go back through free, which counts nothing.
extern "C" void* aligned_alloc(size_t alignment, size_t bytes) noexcept {
  void* block = nullptr;
  if (raygrain::test::fails() || ::posix_memalign(&block, alignment, bytes) != 0) return nullptr;
  return block;
}
