// SPDX-License-Identifier: GPL-3.0-or-later
// Memory that is used again: what a step has given back the next one takes, without asking the
// system.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace cordon {

/// Memory as that of malloc, of which free may give it back as well: of each thread's own store,
/// and otherwise of malloc. nullptr: there is none. O(1).
void* take_memory(std::size_t size) noexcept;
/// As realloc does it, of memory of `take_memory` or malloc.
void* resize_memory(void* memory, std::size_t size) noexcept;
/// Memory of `take_memory` or malloc, whatever thread has taken it: kept for the next one that asks
/// for as much, up to 8 MiB for each thread, and 1 MiB for a block. nullptr is left alone.
void give_memory(void* memory) noexcept;

/// For containers of the standard library that are made in every step.
template <class T>
struct Recycling {
  static_assert(alignof(T) <= alignof(std::max_align_t));
  using value_type = T;
  Recycling() = default;
  template <class Other>
  Recycling(const Recycling<Other>&) noexcept {}  // NOLINT: as allocators do

  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    if (void* const memory = take_memory(count * sizeof(T))) return static_cast<T*>(memory);
    throw std::bad_alloc();
  }
  void deallocate(T* memory, std::size_t) noexcept { give_memory(memory); }
  friend bool operator==(const Recycling&, const Recycling&) { return true; }
};

template <class T>
using RecycledVector = std::vector<T, Recycling<T>>;

}  // namespace cordon
