// SPDX-License-Identifier: GPL-3.0-or-later
// Counts allocations by standing in front of those of the C library, which operator new and Eigen
// call (glibc only).
#include "allocations.hpp"

#include <cstddef>

namespace {
thread_local long count = 0;
}

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t number, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  ++count;
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  ++count;
  return __libc_calloc(number, size);
}
void* realloc(void* memory, std::size_t size) {
  ++count;
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++count;
  return __libc_memalign(alignment, size);
}
}

namespace cordon::bench {

long allocations() { return count; }

}  // namespace cordon::bench
