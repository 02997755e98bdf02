// SPDX-License-Identifier: GPL-3.0-or-later
#include "directions.hpp"

#include <algorithm>

#include "cordon/core/column_elimination.hpp"
#include "cordon/core/exact_rank.hpp"
#include "cordon/core/linalg.hpp"
#include "study/data/random.hpp"

namespace cordon::verification {

Matrix directions_of(Index n, std::int64_t random, std::uint64_t seed, Index k) {
  Matrix D(n, 2 * n + random);
  D.leftCols(n).setIdentity();
  D.middleCols(n, n) = -Matrix::Identity(n, n);
  detail::RandomStream stream(seed, detail::Purpose::direction, static_cast<std::uint64_t>(k));
  for (Index j = 2 * n; j < D.cols(); ++j) {
    for (Index i = 0; i < n; ++i) D(i, j) = stream.symmetric();
  }
  return D;
}

bool hides_directions(const Matrix& A) {
  constexpr double little = 1e-6;
  const Index known =
      std::min(ColumnElimination(A, A.cwiseAbs()).kept, linalg::range_basis(A, little).cols());
  return known < A.cols() && known < rank_modulo_prime(A);
}

}  // namespace cordon::verification
