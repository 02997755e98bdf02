// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/random.hpp"

namespace cordon::detail {

namespace {

/// The finaliser of splitmix64: neighbouring seeds give unrelated streams.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, Purpose purpose, std::uint64_t index)
    : engine_(mixed(mixed(mixed(seed) + static_cast<std::uint64_t>(purpose)) + index)) {}

}  // namespace cordon::detail
