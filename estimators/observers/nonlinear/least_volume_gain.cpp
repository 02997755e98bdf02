// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/nonlinear/least_volume_gain.hpp"

#include <Eigen/Geometry>

#include "cordon/solvers/lp.hpp"

namespace cordon::estimators {

namespace {

constexpr Index most_subsets = 500;

/// a_T with det [λ, G_T] = a_Tᵀ λ, for all T, as rows.
Matrix cofactors(const Matrix& G) {
  const Index n = G.rows(), m = G.cols();
  if (n == 1) return Matrix::Ones(1, 1);
  if (n == 2) {
    Matrix made(m, 2);
    made << G.row(1).transpose(), -G.row(0).transpose();
    return made;
  }
  Matrix made(m * (m - 1) / 2, 3);
  Index row = 0;
  for (Index i = 0; i < m; ++i)
    for (Index j = i + 1; j < m; ++j)
      made.row(row++) = Eigen::Vector3d(G.col(i)).cross(Eigen::Vector3d(G.col(j)));
  return made;
}

/// Σ_S |det G_S|: each det is a_Tᵀ g for a T and a column g behind it, and counted n times.
double sum_of_determinants(const Matrix& G, const Matrix& a) {
  return (a * G).cwiseAbs().sum() / static_cast<double>(G.rows());
}

}  // namespace

std::optional<Vector> least_volume_gain(const Matrix& G, const Eigen::RowVectorXd& C,
                                        double sigma) {
  const Index n = G.rows(), m = G.cols();
  if (n > 3 || (n == 3 ? m * (m - 1) / 2 : m) > most_subsets) return std::nullopt;
  const Matrix a = cofactors(G);
  const Index count = a.rows() + 1;
  // Columns λ, s⁺, s⁻: the rows a_Tᵀ λ = s⁺ - s⁻ and, the last one, C λ - 1 = s⁺ - s⁻.
  Matrix A = Matrix::Zero(count, n + 2 * count);
  A.topLeftCorner(a.rows(), n) = a;
  A.row(count - 1).head(n) = C;
  A.middleCols(n, count) = -Matrix::Identity(count, count);
  A.rightCols(count) = Matrix::Identity(count, count);
  Vector b = Vector::Zero(count), lower = Vector::Zero(A.cols()),
         upper = Vector::Constant(A.cols(), infinity), gain = Vector::Zero(A.cols());
  b[count - 1] = 1;
  lower.head(n).setConstant(-infinity);
  gain.segment(n, count).setConstant(-sigma);
  gain.tail(count).setConstant(-sigma);
  gain[n + count - 1] = gain[n + 2 * count - 1] = -sum_of_determinants(G, a);
  const LinearProgram::Solution found = LinearProgram(A, b, lower, upper).maximize(gain);
  if (found.status != LinearProgram::Status::optimal || !found.x.head(n).allFinite())
    return std::nullopt;
  return Vector(found.x.head(n));
}

}  // namespace cordon::estimators
