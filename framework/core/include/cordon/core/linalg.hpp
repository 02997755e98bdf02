// SPDX-License-Identifier: GPL-3.0-or-later
// Dense decompositions behind plain functions. No other file includes Eigen's decomposition
// headers: each costs seconds of compile time in every file that sees it.
#pragma once

#include <complex>
#include <optional>

#include "cordon/core/types.hpp"

namespace cordon::linalg {

struct Svd {
  Matrix U;      ///< m×m orthogonal
  Vector sigma;  ///< min(m,n) singular values, decreasing
  Matrix V;      ///< n×n orthogonal; A = U diag(σ) Vᵀ
};

/// Full singular value decomposition. Empty matrices give identities.
Svd svd(MatrixIn A);

/// U of the decomposition alone, the same numbers: V of a wide matrix costs much more.
Matrix principal_axes(MatrixIn A);

/// Number of singular values above `relative_tolerance` · σ₁ (0 for a zero matrix).
Index rank(MatrixIn A, double relative_tolerance = 1e-10);

/// Moore-Penrose inverse; singular values up to `relative_tolerance` · σ₁ count as zero.
Matrix pseudo_inverse(MatrixIn A, double relative_tolerance = 1e-12);

/// Orthonormal basis of the range of A (n×r), by column-pivoted QR with a relative tolerance on R's
/// diagonal.
Matrix range_basis(MatrixIn A, double relative_tolerance = 1e-10);

/// Q (m×m orthogonal) of a QR decomposition of A with column pivoting: its first column points
/// along the longest column of A, its second along what the first leaves of the next, and so on;
/// columns beyond A's rank complete it.
Matrix orthogonal_axes(MatrixIn A);

/// Orthonormal basis of the null space of A (n×(n-r)), by singular values.
Matrix null_space(MatrixIn A, double relative_tolerance = 1e-10);

/// X with A X = B for square A (partial-pivoted LU), or nothing when A is numerically singular
/// (reciprocal condition < 1e-14).
std::optional<Matrix> solve(MatrixIn A, MatrixIn B);

/// X with A X = B for symmetric positive definite A (Cholesky), or nothing when a pivot is not
/// positive.
std::optional<Matrix> solve_spd(MatrixIn A, MatrixIn B);

/// L with L Lᵀ = A (lower Cholesky factor), or nothing when a pivot is not positive.
std::optional<Matrix> cholesky(MatrixIn A);

/// Eigenvectors (columns) of a symmetric matrix by increasing eigenvalue.
struct SymmetricEigen {
  Vector values;
  Matrix vectors;
};
SymmetricEigen symmetric_eigen(MatrixIn A);

/// Eigenvalues of a square matrix.
Eigen::VectorXcd eigenvalues(MatrixIn A);

/// Eigenvalues with eigenvectors of length 1 (columns). Pairs of conjugates stand side by side, the
/// upper half plane first. A matrix without a basis of eigenvectors shows in their condition.
struct ComplexEigen {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
};
ComplexEigen complex_eigen(MatrixIn A);

double determinant(MatrixIn A);

/// A B through one compiled kernel (Eigen's product templates are expensive to compile in every
/// file).
Matrix product(MatrixIn A, MatrixIn B);
/// C = A B, in place: C has the shape already, a block of a larger matrix for example, and shares
/// no memory with A and B.
void product(MatrixIn A, MatrixIn B, Eigen::Ref<Matrix> C);

/// Aᵀ B, without a copy of Aᵀ.
Matrix transposed_product(MatrixIn A, MatrixIn B);

/// A Aᵀ, at half the cost of a product.
Matrix gram(MatrixIn A);
/// K = A Aᵀ; a K of that shape keeps its memory. It shares none with A.
void gram(MatrixIn A, Matrix& K);

/// A B with entries that cancel to 1e-14 of their terms or less set to zero: for coefficients of
/// unbounded variables and of whole equations, where rounding noise would turn into a statement.
/// Throws Errc::not_finite if the product overflows.
Matrix denoised_product(MatrixIn A, MatrixIn B);

/// Powers of two near 1 / max|row|, so that scaling by them is exact; 1 for zero rows.
Vector row_scales(MatrixIn A);

/// [A 0; 0 B].
Matrix block_diagonal(MatrixIn A, MatrixIn B);

}  // namespace cordon::linalg
