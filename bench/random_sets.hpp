// SPDX-License-Identifier: GPL-3.0-or-later
// Random constrained sets of the sizes (states, generators, constraints) that all measurements share.
#pragma once

#include <random>

#include <benchmark/benchmark.h>

#include "cordon/core/line_form.hpp"

namespace cordon::bench {

struct Size {
  Index n, g, m;
};

inline Size size(const benchmark::State& state) { return {state.range(0), state.range(1), state.range(2)}; }

inline Matrix random_matrix(std::mt19937_64& engine, Index rows, Index cols) {
  Matrix A(rows, cols);
  for (Index k = 0; k < A.size(); ++k) A.data()[k] = static_cast<double>(engine() >> 11) * 0x1p-52 - 1;
  return A;
}

/// Feasible by construction: b = A ξ for a ξ inside the box.
inline LineForm random_set(Size s, std::uint64_t seed = 1) {
  std::mt19937_64 engine(seed);
  LineForm X = make_zonotope(random_matrix(engine, s.n, 1), random_matrix(engine, s.n, s.g));
  X.A = random_matrix(engine, s.m, s.g);
  X.b = X.A * (0.7 * random_matrix(engine, s.g, 1));
  X.S.resize(s.m, 0);
  return X;
}

inline void sizes(benchmark::internal::Benchmark* b) {
  b->Args({3, 30, 5})->Args({10, 100, 20})->Args({20, 200, 50})->Repetitions(7)->Unit(benchmark::kMicrosecond)->MinTime(.05);
}

}  // namespace cordon::bench
