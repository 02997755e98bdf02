// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of polytopes: the rows of the unit box, and the code of an error.
#pragma once

#include <functional>

#include "cordon/core/error.hpp"
#include "cordon/core/types.hpp"

namespace solvers_test {

using namespace cordon;

inline Matrix stacked(Index n) {
  Matrix H(2 * n, n);
  H << Matrix::Identity(n, n), -Matrix::Identity(n, n);
  return H;
}

inline Errc code_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const Error& error) {
    return error.code();
  }
  return Errc::internal;
}

}  // namespace solvers_test
