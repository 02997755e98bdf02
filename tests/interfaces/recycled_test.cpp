// SPDX-License-Identifier: GPL-3.0-or-later
// Memory that is used again is that of malloc, of the size that was asked for, and of any thread.
#include "cordon/core/recycled.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <random>
#include <thread>

#include <doctest/doctest.h>

using namespace cordon;

TEST_CASE("blocks hold what was asked for, and do not overlap") {
  std::mt19937_64 random(1);
  struct Block {
    unsigned char* at;
    std::size_t size;
    unsigned char fill;
  };
  std::vector<Block> held;
  const auto check = [](const Block& block) {
    REQUIRE(std::all_of(block.at, block.at + block.size,
                        [&](unsigned char byte) { return byte == block.fill; }));
  };
  for (int round = 0; round < 50'000; ++round) {
    const std::size_t size = random() % (round % 100 == 0 ? 3'000'000
                                         : round % 3 == 0 ? 5000
                                                          : 200);
    switch (held.empty() ? 0 : random() % 4) {
      case 0:
      case 1: {
        auto* const at = static_cast<unsigned char*>(take_memory(size));
        REQUIRE(at != nullptr);
        REQUIRE(reinterpret_cast<std::uintptr_t>(at) % alignof(std::max_align_t) == 0);
        held.push_back({at, size, static_cast<unsigned char>(random())});
        std::memset(at, held.back().fill, size);
        break;
      }
      case 2: {
        Block& block = held[random() % held.size()];
        const std::size_t kept = std::min(block.size, size);
        block.at = static_cast<unsigned char*>(resize_memory(block.at, size));
        REQUIRE(block.at != nullptr);
        REQUIRE(std::all_of(block.at, block.at + kept,
                            [&](unsigned char byte) { return byte == block.fill; }));
        block.size = size;
        std::memset(block.at, block.fill, size);
        break;
      }
      default: {
        std::swap(held[random() % held.size()], held.back());
        check(held.back());
        round % 5 == 0 ? std::free(held.back().at) : give_memory(held.back().at);
        held.pop_back();
      }
    }
  }
  for (const Block& block : held) {
    check(block);
    give_memory(block.at);
  }
}

TEST_CASE("blocks of malloc, of other threads and of threads that have ended are taken") {
  give_memory(nullptr);
  for (const std::size_t size : {1, 24, 25, 64, 1000, 1024, 1025, 100'000, 2'000'000})
    give_memory(std::malloc(size));
  std::vector<void*> blocks;
  std::thread([&] {
    for (std::size_t size = 1; size < 4000; size += 7) blocks.push_back(take_memory(size));
    give_memory(take_memory(100));
  }).join();
  for (void* const block : blocks) give_memory(block);
  std::thread([&] {
    RecycledVector<double> numbers(1000);
    std::iota(numbers.begin(), numbers.end(), 0.0);
    numbers.resize(5000);
    CHECK(numbers[999] == 999);
  }).join();
  CHECK_THROWS_AS(Recycling<double>().allocate(static_cast<std::size_t>(-1) / 4),
                  std::bad_array_new_length);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_CASE("what was given back is taken next, and what there is not is none") {
  CHECK(take_memory(static_cast<std::size_t>(1) << 62) == nullptr);
  for (const std::size_t size : {1, 64, 65, 1000, 1200, 5000, 900'000}) {
    void* const first = take_memory(size);
    give_memory(first);
    void* const second = take_memory(size);
    CHECK(first == second);
    give_memory(second);
  }
}
#endif
