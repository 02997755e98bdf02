// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <random>
#include <string_view>

#include "cordon/core/types.hpp"

namespace cordon::conformance {

/// Numbers that are the same on every machine: the engine is fixed by the standard, the
/// distributions are not and are made here.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  std::uint64_t bits() { return engine_(); }
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }  ///< in [0, 1)
  bool chance(double probability) { return unit() < probability; }
  Index below(Index n) {
    return static_cast<Index>(unit() * static_cast<double>(n));
  }  ///< in {0 … n-1}
  Index between(Index lowest, Index highest) { return lowest + below(highest - lowest + 1); }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }

 private:
  std::mt19937_64 engine_;
};

/// A seed of its own for each law and case, so that a case does not depend on which others were
/// run.
inline std::uint64_t seed_of(std::uint64_t seed, std::string_view law, Index number) {
  std::uint64_t hash = 0xcbf29ce484222325u ^ (seed * 0x9e3779b97f4a7c15u);
  for (const char c : law) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  hash ^= static_cast<std::uint64_t>(number) + 0x9e3779b97f4a7c15u;
  hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9u;
  hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebu;
  return hash ^ (hash >> 31);
}

}  // namespace cordon::conformance
