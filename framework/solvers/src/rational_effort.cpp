// SPDX-License-Identifier: GPL-3.0-or-later
// Operations that rational arithmetic needs, by the size of the rows and of their numbers.
#include "rational_effort.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/solvers/limits.hpp"

namespace cordon {

namespace {

/// Rational arithmetic beyond about a second is not worth an answer. Numbers grow with the spread
/// of the exponents.
bool is_affordable(double operations, MatrixIn S, MatrixIn A) {
  if (LimitedSolvers::is_over()) return false;
  double smallest = infinity, largest = 0;
  for (const MatrixIn* block : {&S, &A}) {
    for (Index j = 0; j < block->cols(); ++j) {
      for (Index i = 0; i < block->rows(); ++i) {
        const double entry = std::abs((*block)(i, j));
        if (entry == 0) continue;
        smallest = std::min(smallest, entry);
        largest = std::max(largest, entry);
      }
    }
  }
  const double words = largest > 0 ? 1 + (std::log2(largest) - std::log2(smallest)) / 53 : 1;
  return operations * words * words <= 3e5;
}

}  // namespace

bool is_small(MatrixIn S, MatrixIn A) {
  const double m = static_cast<double>(A.rows()),
               columns = static_cast<double>(S.cols() + A.cols());
  return is_affordable(m * m * columns, S, A);
}

bool has_few_lines(MatrixIn S, MatrixIn A) {
  const double m = static_cast<double>(A.rows()), l = static_cast<double>(S.cols()),
               g = static_cast<double>(A.cols());
  return is_affordable(m * (l * l + g), S, A);
}

}  // namespace cordon
