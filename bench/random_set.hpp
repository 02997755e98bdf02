// SPDX-License-Identifier: GPL-3.0-or-later
// Random constrained sets that all measurements share.
#pragma once

#include <random>

#include "cordon/core/line_form.hpp"

namespace cordon::bench {

/// States, generators, constraints.
struct Size {
  Index n, g, m;
};

inline Matrix random_matrix(std::mt19937_64& engine, Index rows, Index cols) {
  Matrix A(rows, cols);
  for (Index k = 0; k < A.size(); ++k)
    A.data()[k] = static_cast<double>(engine() >> 11) * 0x1p-52 - 1;
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

}  // namespace cordon::bench
