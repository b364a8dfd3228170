#include "numeric/memory.hpp"

#include <cstdint>

#if defined(_WIN32)
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#else
#include <sys/mman.h>
#endif

namespace railpatch {

// With the sanitizer memory is that of operator new, whose ends it watches.
#if defined(__SANITIZE_ADDRESS__)

void *take_pages(size_t bytes) {
  void *pages = ::operator new[](bytes, std::align_val_t{64});
  std::uninitialized_value_construct_n(static_cast<unsigned char *>(pages), bytes);
  return pages;
}
void give_pages(void *pages, size_t) { ::operator delete[](pages, std::align_val_t{64}); }

#else

namespace {

constexpr size_t page = 4096;

#if defined(_WIN32)
void *map(size_t bytes) {
  return VirtualAlloc(nullptr, bytes, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE);
}
void unmap(void *pages, size_t) { VirtualFree(pages, 0, MEM_RELEASE); }
#else
void *map(size_t bytes) {
  void *pages = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return pages == MAP_FAILED ? nullptr : pages;
}
void unmap(void *pages, size_t bytes) { munmap(pages, bytes); }
#endif

// Buffers that all began at a page's start would share the same few lines of the cache.
size_t shift_of(uintptr_t at) { return (at / page * 7 % 64) * 64; }

}  // namespace

void *take_pages(size_t bytes) {
  void *pages = map(bytes + page);
  if (!pages) throw std::bad_alloc();
  return static_cast<char *>(pages) + shift_of(reinterpret_cast<uintptr_t>(pages));
}
void give_pages(void *pages, size_t bytes) {
  char *at = static_cast<char *>(pages);
  unmap(at - reinterpret_cast<uintptr_t>(at) % page, bytes + page);
}

#endif

}  // namespace railpatch
