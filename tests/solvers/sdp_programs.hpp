// SPDX-License-Identifier: GPL-3.0-or-later
// Semidefinite programs, and what a proof that one has no solution must keep.
#pragma once

#include <random>

#include <doctest/doctest.h>

#include "cordon/core/linalg.hpp"
#include "cordon/sdp/sdp.hpp"

namespace solvers_test {

using namespace cordon;

inline Matrix scalar(double value) { return Matrix::Constant(1, 1, value); }

/// minimise t with t I - A ⪰ 0: the largest eigenvalue of A.
inline SemidefiniteProgram largest_eigenvalue(const Matrix& A) {
  return {Vector::Ones(1), {{-A, {{0, Matrix::Identity(A.rows(), A.rows())}}}}};
}

inline Matrix random_symmetric(Index n, std::mt19937_64& engine) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Matrix R = Matrix::NullaryExpr(n, n, [&] { return uniform(engine); });
  return (R + R.transpose()) / 2;
}

/// x ≥ 1 and x ≤ 0.
inline SemidefiniteProgram contradiction() {
  return {Vector::Ones(1), {{scalar(-1), {{0, scalar(1)}}}, {scalar(0), {{0, scalar(-1)}}}}};
}

/// The proof by the numbers of the program: Y ⪰ 0, and no x within the bound can make Σ ⟨F(x), Y⟩
/// reach 0.
inline void check_proof(const SemidefiniteProgram& program, const SdpSolution& s,
                        double largest_x) {
  REQUIRE(s.status == SdpStatus::infeasible);
  REQUIRE(s.proof.size() == program.inequalities.size());
  double sum = 0;
  Vector slopes = Vector::Zero(program.cost.size());
  for (std::size_t j = 0; j < s.proof.size(); ++j) {
    CHECK(linalg::symmetric_eigen(s.proof[j]).values[0] >= 0);
    sum += program.inequalities[j].constant.cwiseProduct(s.proof[j]).sum();
    for (const auto& [i, term] : program.inequalities[j].terms)
      slopes[i] += term.cwiseProduct(s.proof[j]).sum();
  }
  CHECK(sum + largest_x * slopes.cwiseAbs().sum() < 0);
}

}  // namespace solvers_test
