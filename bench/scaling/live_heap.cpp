// SPDX-License-Identifier: GPL-3.0-or-later
// Counts live bytes by standing in front of the allocations of the C library, which operator new
// and Eigen call (glibc only).
#include "live_heap.hpp"

#include <cstddef>

namespace {

thread_local bool counting = false;
thread_local long live = 0, highest = 0;

}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t number, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);
std::size_t malloc_usable_size(void* memory);
}

namespace {

void* added(void* memory) {
  if (counting && memory) {
    live += static_cast<long>(malloc_usable_size(memory));
    if (live > highest) highest = live;
  }
  return memory;
}

void removed(void* memory) {
  if (counting && memory) live -= static_cast<long>(malloc_usable_size(memory));
}

}  // namespace

extern "C" {
void* malloc(std::size_t size) { return added(__libc_malloc(size)); }
void* calloc(std::size_t number, std::size_t size) { return added(__libc_calloc(number, size)); }
void* realloc(void* memory, std::size_t size) {
  removed(memory);
  return added(__libc_realloc(memory, size));
}
void* memalign(std::size_t alignment, std::size_t size) {
  return added(__libc_memalign(alignment, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return added(__libc_memalign(alignment, size));
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  constexpr int no_memory = 12;  // ENOMEM
  *memory = added(__libc_memalign(alignment, size));
  return *memory ? 0 : no_memory;
}
void free(void* memory) {
  removed(memory);
  __libc_free(memory);
}
}

namespace cordon::bench {

LiveHeap::LiveHeap() {
  live = highest = 0;
  counting = true;
}
LiveHeap::~LiveHeap() { counting = false; }
long LiveHeap::growth() const { return live; }
long LiveHeap::peak() const { return highest; }

}  // namespace cordon::bench
