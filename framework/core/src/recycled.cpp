// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/recycled.hpp"

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <malloc.h>

// Where calls of malloc are led here (framework/core/malloc), those of this file are not.
#ifdef CORDON_RECYCLES
extern "C" void* __real_malloc(std::size_t size);  // NOLINT: the linker's names
extern "C" void __real_free(void* memory);         // NOLINT
#endif

namespace cordon {

namespace {

#ifdef CORDON_RECYCLES

void* system_malloc(std::size_t size) { return __real_malloc(size); }
void system_free(void* memory) { __real_free(memory); }

/// Sizes of blocks: 64, 128, … 1024, and from there on four to an octave.
constexpr std::size_t finest = 64, small_block = 1024, largest_block = std::size_t{1} << 20,
                      small_kinds = small_block / finest, kinds = small_kinds + 40;
constexpr std::size_t most_kept = std::size_t{8} << 20;

constexpr int exponent(std::size_t size) { return static_cast<int>(std::bit_width(size)) - 1; }

/// The smallest kind of at least so many bytes, 1 to `largest_block`.
constexpr std::size_t kind_for(std::size_t size) {
  if (size <= small_block) return (size + finest - 1) / finest - 1;
  const int e = exponent(size - 1);
  const std::size_t octave = static_cast<std::size_t>(e) - 10, from = std::size_t{1} << e;
  return small_kinds + octave * 4 + (size - 1 - from) / (from / 4);
}
constexpr std::size_t size_of(std::size_t kind) {
  if (kind < small_kinds) return (kind + 1) * finest;
  const std::size_t octave = (kind - small_kinds) / 4, from = small_block << octave;
  return from + ((kind - small_kinds) % 4 + 1) * (from / 4);
}
/// The largest_block kind of at most so many bytes, `finest` or more.
constexpr std::size_t kind_within(std::size_t size) {
  const std::size_t kind = kind_for(size < largest_block ? size : largest_block);
  return size_of(kind) <= size ? kind : kind - 1;
}
static_assert(kind_for(1) == 0 && kind_for(1024) == 15 && size_of(16) == 1280);
static_assert(kind_for(1025) == 16 && kind_for(1280) == 16 && kind_for(1281) == 17);
static_assert(kind_for(largest_block) == kinds - 1 && size_of(kinds - 1) == largest_block);
static_assert(kind_within(64) == 0 && kind_within(127) == 0 && kind_within(1279) == 15);
static_assert(kind_within(1280) == 16 && kind_within(largest_block + 5) == kinds - 1);

/// What one thread has given back: lists of blocks, the next one in the first bytes of each.
class Store {
 public:
  ~Store() {
    for (void*& first : first_) {
      while (void* const block = first) {
        first = *static_cast<void**>(block);
        system_free(block);
      }
    }
  }
  void* take(std::size_t kind) {
    void* const block = first_[kind];
    if (!block) return system_malloc(size_of(kind));
    first_[kind] = *static_cast<void**>(block);
    kept_ -= size_of(kind);
    return block;
  }
  void give(void* block, std::size_t kind) {
    if (kept_ + size_of(kind) > most_kept && !let_go(kind)) return system_free(block);
    *static_cast<void**>(block) = first_[kind];
    first_[kind] = block;
    kept_ += size_of(kind);
  }

 private:
  /// One of a larger kind, the largest that there is, in place of which this one can be kept.
  bool let_go(std::size_t kind) {
    for (std::size_t larger = kinds; --larger > kind;) {
      if (!first_[larger]) continue;
      void* const block = first_[larger];
      first_[larger] = *static_cast<void**>(block);
      kept_ -= size_of(larger);
      system_free(block);
      return true;
    }
    return false;
  }

  void* first_[kinds] = {};
  std::size_t kept_ = 0;
};

/// Of this thread; null where it is ending, and its store is gone.
Store* store() {
  enum class Is { new_, there, gone };
  thread_local Is is = Is::new_;
  thread_local Store* known = nullptr;
  if (is == Is::there) return known;
  if (is == Is::gone) return nullptr;
  struct Owner {
    Store store;
    ~Owner() { is = Is::gone; }
  };
  thread_local Owner owner;
  known = &owner.store;
  is = Is::there;
  return known;
}

#endif

}  // namespace

#ifdef CORDON_RECYCLES

void* take_memory(std::size_t size) noexcept {
  if (size == 0) size = 1;
  Store* const kept = size <= largest_block ? store() : nullptr;
  return kept ? kept->take(kind_for(size)) : system_malloc(size);
}

void* resize_memory(void* memory, std::size_t size) noexcept {
  if (!memory) return take_memory(size);
  const std::size_t room = malloc_usable_size(memory);
  if (size <= room) return memory;
  void* const larger = take_memory(size);
  if (!larger) return nullptr;
  std::memcpy(larger, memory, room);
  give_memory(memory);
  return larger;
}

void give_memory(void* memory) noexcept {
  if (!memory) return;
  const std::size_t size = malloc_usable_size(memory);
  const bool is_kept = size >= finest && size <= largest_block + largest_block / 4;
  Store* const kept = is_kept ? store() : nullptr;
  kept ? kept->give(memory, kind_within(size)) : system_free(memory);
}

#else  // sanitizers want to see every block

void* take_memory(std::size_t size) noexcept { return std::malloc(size > 0 ? size : 1); }
void* resize_memory(void* memory, std::size_t size) noexcept {
  return std::realloc(memory, size > 0 ? size : 1);
}
void give_memory(void* memory) noexcept { std::free(memory); }

#endif

}  // namespace cordon
