// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/linalg.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "cordon/core/error.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/core/vectors.hpp"

namespace cordon::linalg {

namespace {

Index count_above(const Vector& sigma, double relative_tolerance) {
  if (sigma.size() == 0 || sigma[0] == 0) return 0;
  return (sigma.array() > relative_tolerance * sigma[0]).count();
}

/// S⁻¹ A S with powers of two in S, so that rows and columns have like norms: eigenvalues of states
/// in unlike units would drown in the rounding errors of the largest entries.
Matrix balanced(Matrix A) {
  const Index n = A.rows();
  for (int sweep = 0, changed = 1; changed && sweep < 100; ++sweep) {
    changed = 0;
    for (Index i = 0; i < n; ++i) {
      const double own = std::abs(A(i, i)), row = A.row(i).cwiseAbs().sum() - own,
                   col = A.col(i).cwiseAbs().sum() - own;
      if (!(row > 0 && col > 0) || !std::isfinite(row) || !std::isfinite(col)) continue;
      const int power = static_cast<int>(std::lround(0.5 * (std::log2(row) - std::log2(col))));
      if (power == 0) continue;
      A.col(i) *= std::ldexp(1.0, power);
      A.row(i) *= std::ldexp(1.0, -power);
      changed = 1;
    }
  }
  return A;
}

}  // namespace

Svd svd(MatrixIn A) {
  const Index m = A.rows(), n = A.cols();
  if (m == 0 || n == 0) return {Matrix::Identity(m, m), Vector(0), Matrix::Identity(n, n)};
  const Eigen::JacobiSVD<Matrix> decomposition(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {decomposition.matrixU(), decomposition.singularValues(), decomposition.matrixV()};
}

Matrix principal_axes(MatrixIn A) {
  if (A.rows() == 0 || A.cols() == 0) return Matrix::Identity(A.rows(), A.rows());
  return Eigen::JacobiSVD<Matrix>(A, Eigen::ComputeFullU).matrixU();
}

Index rank(MatrixIn A, double relative_tolerance) {
  return count_above(svd(A).sigma, relative_tolerance);
}

Matrix pseudo_inverse(MatrixIn A, double relative_tolerance) {
  const Svd d = svd(A);
  const Index r = count_above(d.sigma, relative_tolerance);
  Matrix inverse = Matrix::Zero(A.cols(), A.rows());
  for (Index i = 0; i < r; ++i) inverse += d.V.col(i) * (d.U.col(i).transpose() / d.sigma[i]);
  return inverse;
}

Matrix range_basis(MatrixIn A, double relative_tolerance) {
  if (A.cols() == 0 || A.rows() == 0) return Matrix(A.rows(), 0);
  Eigen::ColPivHouseholderQR<Matrix> qr(A);
  qr.setThreshold(relative_tolerance);
  const Index r = A.isZero(0) ? 0 : qr.rank();
  Matrix Q = Matrix::Identity(A.rows(), r);
  Q.applyOnTheLeft(qr.householderQ());
  return Q;
}

Matrix orthogonal_axes(MatrixIn A) {
  if (A.cols() == 0 || A.rows() == 0) return Matrix::Identity(A.rows(), A.rows());
  return Eigen::ColPivHouseholderQR<Matrix>(A).householderQ();
}

Matrix null_space(MatrixIn A, double relative_tolerance) {
  const Svd d = svd(A);
  const Index r = count_above(d.sigma, relative_tolerance);
  return d.V.rightCols(A.cols() - r);
}

std::optional<Matrix> solve(MatrixIn A, MatrixIn B) {
  if (A.rows() == 0) return Matrix(0, B.cols());
  const Eigen::PartialPivLU<Matrix> lu(A);
  const double condition = lu.rcond();
  if (!(condition >= 1e-14)) return std::nullopt;
  return Matrix(lu.solve(B));
}

namespace {

/// So many equations that preparing for large systems would cost more than solving them.
constexpr Index few = 4;

std::optional<Matrix> solve_few_spd(MatrixIn A, MatrixIn B) {
  const Index m = A.rows();
  double L[few][few] = {}, inverse[few] = {};
  for (Index k = 0; k < m; ++k) {
    double square = 0;
    for (Index j = 0; j < k; ++j) square += L[k][j] * L[k][j];
    const double pivot = A(k, k) - square;
    if (!(pivot > 0)) return std::nullopt;
    const double root = std::sqrt(pivot);
    inverse[k] = 1 / root;
    for (Index i = k + 1; i < m; ++i) {
      double product = 0;
      for (Index j = 0; j < k; ++j) product += L[i][j] * L[k][j];
      L[i][k] = (A(i, k) - product) / root;
    }
  }
  Matrix X = B;
  for (Index c = 0; c < X.cols(); ++c) {
    double* const x = &X(0, c);
    for (Index k = 0; k < m; ++k) {
      x[k] *= inverse[k];
      for (Index i = k + 1; i < m; ++i) x[i] -= x[k] * L[i][k];
    }
    for (Index k = m - 1; k >= 0; --k) {
      double sum = 0;
      for (Index i = k + 1; i < m; ++i) sum += L[i][k] * x[i];
      x[k] = (x[k] - sum) * inverse[k];
    }
  }
  if (!vectors::all_finite(X)) return std::nullopt;
  return X;
}

}  // namespace

std::optional<Matrix> solve_spd(MatrixIn A, MatrixIn B) {
  if (A.rows() == 0) return Matrix(0, B.cols());
  if (A.rows() <= few) return solve_few_spd(A, B);
  const Eigen::LLT<Matrix> llt(A);
  if (llt.info() != Eigen::Success) return std::nullopt;
  Matrix X = llt.solve(B);
  if (!X.allFinite()) return std::nullopt;
  return X;
}

std::optional<Matrix> cholesky(MatrixIn A) {
  if (A.rows() == 0) return Matrix(0, 0);
  const Eigen::LLT<Matrix> llt(A);
  if (llt.info() != Eigen::Success) return std::nullopt;
  return Matrix(llt.matrixL());
}

SymmetricEigen symmetric_eigen(MatrixIn A) {
  if (A.rows() == 0) return {Vector(0), Matrix(0, 0)};
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(A);
  if (solver.info() != Eigen::Success)
    throw Error(Errc::solver, "eigenvalues of a symmetric matrix did not converge");
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXcd eigenvalues(MatrixIn A) {
  if (A.rows() == 0) return Eigen::VectorXcd(0);
  const Eigen::EigenSolver<Matrix> solver(balanced(A), false);
  if (solver.info() != Eigen::Success) throw Error(Errc::solver, "eigenvalues did not converge");
  return solver.eigenvalues();
}

ComplexEigen complex_eigen(MatrixIn A) {
  if (A.rows() == 0) return {Eigen::VectorXcd(0), Eigen::MatrixXcd(0, 0)};
  const Eigen::EigenSolver<Matrix> solver(A, true);
  if (solver.info() != Eigen::Success) throw Error(Errc::solver, "eigenvalues did not converge");
  return {solver.eigenvalues(), solver.eigenvectors()};
}

double determinant(MatrixIn A) { return A.rows() == 0 ? 1.0 : Matrix(A).determinant(); }

Matrix product(MatrixIn A, MatrixIn B) {
  Matrix C(A.rows(), B.cols());
  product(A, B, C);
  return C;
}

void product(MatrixIn A, MatrixIn B, Eigen::Ref<Matrix> C) {
  if (A.cols() == 0) {
    C.setZero();
  } else if (vectors::is_small(A)) {
    vectors::small_product(A, B, C);
  } else {
    C.noalias() = A * B;
  }
}

Matrix transposed_product(MatrixIn A, MatrixIn B) {
  Matrix C(A.cols(), B.cols());
  if (A.rows() == 0) return C.setZero();
  if (B.cols() == 1 && A.rows() <= 12) {
    for (Index j = 0; j < A.cols(); ++j) {
      double sum = 0;
      for (Index i = 0; i < A.rows(); ++i) sum += A(i, j) * B(i, 0);
      C(j, 0) = sum;
    }
  } else {
    C.noalias() = A.transpose() * B;
  }
  return C;
}

Matrix gram(MatrixIn A) {
  Matrix K;
  gram(A, K);
  return K;
}

void gram(MatrixIn A, Matrix& K) {
  if (A.rows() <= 6) {
    vectors::small_gram(A, K);
    return;
  }
  K.setZero(A.rows(), A.rows());
  if (A.cols() == 0) return;  // Eigen divides by it where there are 48 rows or more
  K.selfadjointView<Eigen::Lower>().rankUpdate(A);
  K.triangularView<Eigen::StrictlyUpper>() = K.transpose();
}

namespace {

[[noreturn]] void refuse_overflow() {
  throw Error(Errc::not_finite, "a matrix product overflows; scale the problem");
}

/// The same sums in one pass. Terms that overflow in sum are refused as well: nothing could be told
/// from their noise.
Matrix small_denoised_product(MatrixIn A, MatrixIn B) {
  Matrix C(A.rows(), B.cols());
  double overflow = 0;  // NaN after one
  for (Index j = 0; j < B.cols(); ++j) {
    for (Index i = 0; i < A.rows(); ++i) {
      double sum = 0, size = 0;
      for (Index k = 0; k < A.cols(); ++k) {
        const double term = A(i, k) * B(k, j);
        sum += term;
        size += std::abs(term);
      }
      C(i, j) = std::abs(sum) <= tolerances::product_noise * size ? 0 : sum;
      overflow += 0.0 * size;
    }
  }
  if (overflow != 0) refuse_overflow();
  return C;
}

}  // namespace

Matrix denoised_product(MatrixIn A, MatrixIn B) {
  if (vectors::is_small(A)) return small_denoised_product(A, B);
  Matrix C = product(A, B);
  if (C.size() == 0) return C;
  if (!vectors::all_finite(C)) refuse_overflow();
  const Matrix magnitude = product(A.cwiseAbs(), B.cwiseAbs());
  return (C.array().abs() <= tolerances::product_noise * magnitude.array()).select(0.0, C);
}

Vector row_scales(MatrixIn A) {
  Vector scale = Vector::Ones(A.rows());
  for (Index i = 0; i < A.rows(); ++i) {
    const double largest = A.cols() ? A.row(i).cwiseAbs().maxCoeff() : 0.0;
    if (largest > 0)
      scale[i] = std::ldexp(1.0, std::min(1000, std::max(-1000, -std::ilogb(largest))));
  }
  return scale;
}

Matrix block_diagonal(MatrixIn A, MatrixIn B) {
  Matrix C = Matrix::Zero(A.rows() + B.rows(), A.cols() + B.cols());
  C.topLeftCorner(A.rows(), A.cols()) = A;
  C.bottomRightCorner(B.rows(), B.cols()) = B;
  return C;
}

}  // namespace cordon::linalg
