// SPDX-License-Identifier: GPL-3.0-or-later
// Where the linker leads the calls of malloc, calloc, realloc and free in Cordon's own libraries
// and plugins, most of them Eigen's: `--wrap`, as cmake/Recycling.cmake says.
#include <cstring>

#include "cordon/core/recycled.hpp"

extern "C" {
void* __wrap_malloc(std::size_t size);                     // NOLINT: the linker's names
void* __wrap_calloc(std::size_t count, std::size_t size);  // NOLINT: of zeros that GCC sees coming
void* __wrap_realloc(void* memory, std::size_t size);      // NOLINT
void __wrap_free(void* memory);                            // NOLINT

void* __wrap_malloc(std::size_t size) { return cordon::take_memory(size); }
void* __wrap_calloc(std::size_t count, std::size_t size) {
  std::size_t all = 0;
  if (__builtin_mul_overflow(count, size, &all)) return nullptr;
  void* const memory = cordon::take_memory(all);
  return memory ? std::memset(memory, 0, all) : nullptr;
}
void* __wrap_realloc(void* memory, std::size_t size) { return cordon::resize_memory(memory, size); }
void __wrap_free(void* memory) { cordon::give_memory(memory); }
}
