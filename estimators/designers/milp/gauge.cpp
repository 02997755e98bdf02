// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/milp/gauge.hpp"

#include <limits>

namespace cordon::designers {

namespace {

/// Columns (λ, μ₁, μ₂, slack), rows Gᵀλ - μ₁ + μ₂ = 0 and 1ᵀ(μ₁ + μ₂) + slack = 1.
LinearProgram dual_program(const Matrix& G) {
  const Index m = G.rows(), g = G.cols(), n = m + 2 * g + 1;
  Matrix A = Matrix::Zero(g + 1, n);
  A.topLeftCorner(g, m) = G.transpose();
  A.block(0, m, g, g) = -Matrix::Identity(g, g);
  A.block(0, m + g, g, g).setIdentity();
  A.row(g).tail(2 * g + 1).setOnes();
  Vector b = Vector::Zero(g + 1), lower = Vector::Zero(n), upper = Vector::Ones(n);
  b[g] = 1;
  lower.head(m).setConstant(-infinity);
  upper.head(m).setConstant(infinity);
  return {A, b, lower, upper};
}

}  // namespace

Gauge::Gauge(const Matrix& G) : rows_(G.rows()), generators_(G.cols()), program_(dual_program(G)) {}

std::optional<Gauge::Value> Gauge::at(const Vector& z) {
  Vector objective = Vector::Zero(rows_ + 2 * generators_ + 1);
  objective.head(rows_) = z;
  LinearProgram::Solution solution = program_.maximize(objective);
  if (solution.status != LinearProgram::Status::optimal) return std::nullopt;
  return Value{solution.objective, solution.x.head(rows_), solution.y.head(generators_)};
}

}  // namespace cordon::designers
