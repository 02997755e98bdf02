// SPDX-License-Identifier: GPL-3.0-or-later
// The sizes (states, generators, constraints) of random sets that all measurements share.
#pragma once

#include <benchmark/benchmark.h>

#include "random_set.hpp"

namespace cordon::bench {

inline Size size(const benchmark::State& state) {
  return {state.range(0), state.range(1), state.range(2)};
}

inline void sizes(benchmark::internal::Benchmark* b) {
  b->Args({3, 30, 5})
      ->Args({10, 100, 20})
      ->Args({20, 200, 50})
      ->Repetitions(7)
      ->Unit(benchmark::kMicrosecond)
      ->MinTime(.05);
}

}  // namespace cordon::bench
