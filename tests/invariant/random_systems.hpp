// SPDX-License-Identifier: GPL-3.0-or-later
// Random Schur matrices with disturbances, and what an error says.
#pragma once

#include <algorithm>
#include <functional>
#include <random>
#include <string>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/invariant/schur.hpp"
#include "cordon/sets/zonotope.hpp"

namespace invariant_test {

using namespace cordon;
using namespace cordon::invariant;
using sets::Zonotope;

inline std::string message(const std::function<void()>& call, Errc expected) {
  try {
    call();
  } catch (const Error& error) {
    CHECK(error.code() == expected);
    return error.what();
  }
  FAIL("no error");
  return {};
}

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

inline Matrix uniform(std::mt19937_64& engine, Index rows, Index cols, double size) {
  std::uniform_real_distribution<double> draw(-size, size);
  Matrix M(rows, cols);
  for (Index i = 0; i < rows; ++i) {
    for (Index j = 0; j < cols; ++j) M(i, j) = draw(engine);
  }
  return M;
}

struct System {
  Matrix A;
  Zonotope D;
};

/// Schur matrices of spectral radius `radius`; random real matrices have complex pairs as a rule.
inline System random_system(std::mt19937_64& engine, double radius) {
  const Index n = std::uniform_int_distribution<Index>(1, 5)(engine),
              g = std::uniform_int_distribution<Index>(1, 6)(engine);
  Matrix A = uniform(engine, n, n, 1);
  A *= radius / std::max(spectral_radius(A), 1e-3);
  return {A, {uniform(engine, n, 1, 1), uniform(engine, n, g, 1)}};
}

}  // namespace invariant_test
