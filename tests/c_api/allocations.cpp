// SPDX-License-Identifier: GPL-3.0-or-later
#include "c_api/allocations.hpp"

#include <cstdlib>
#include <new>

namespace c_test {

namespace {
constexpr std::int64_t never = -1;
thread_local std::int64_t left = never;
thread_local bool failed = false;
}  // namespace

void fail_after(std::int64_t n) {
  left = n;
  failed = false;
}

bool has_failed() {
  left = never;
  return failed;
}

}  // namespace c_test

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
void* operator new(std::size_t size) {
  using namespace c_test;
  if (left >= 0 && left-- == 0) {
    failed = true;
    throw std::bad_alloc();
  }
  if (void* const memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
#endif
