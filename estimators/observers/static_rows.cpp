// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/static_rows.hpp"

#include <cmath>

#include "cordon/interfaces/descriptor_matrix.hpp"

namespace cordon::estimators {

namespace {

/// An orthogonal factor without entries that are zero up to the rounding of the decomposition.
Matrix denoised(const Matrix& Q) { return (Q.array().abs() <= 1e-15).select(0.0, Q); }

/// Row scales of E x⁺ = …: each row by its entries in E, static rows by those of A. The equation stays the same, and the rank of
/// E does not depend on units.
Vector equation_scales(const LinearModel& m) {
  Vector scale = linalg::row_scales(m.E);
  const Vector of_A = linalg::row_scales(m.A);
  for (Index i = 0; i < scale.size(); ++i) {
    if (m.E.row(i).isZero(0)) scale[i] = of_A[i];
  }
  return scale;
}

/// One power of two in each row.
bool scales_exactly(const Matrix& left) {
  for (Index i = 0; i < left.rows(); ++i) {
    if ((left.row(i).array() != 0).count() != 1) return false;
    int exponent = 0;
    if (std::frexp(left.row(i).cwiseAbs().maxCoeff(), &exponent) != 0.5) return false;
  }
  return true;
}

}  // namespace

StaticRows::StaticRows(const LinearModel& m) {
  const Index n = m.states();
  const Vector units = m.is_descriptor() ? equation_scales(m) : Vector(Vector::Ones(n));
  const linalg::Svd d = linalg::svd(m.is_descriptor() ? Matrix(units.asDiagonal() * m.E) : Matrix(Matrix::Identity(n, n)));
  sigma = d.sigma;
  const Index rank = m.is_descriptor() ? descriptor_rank(m.E) : n;
  Vector scale = Vector::Ones(n);
  for (Index i = 0; i < rank; ++i) scale[i] = 1 / d.sigma[i];
  const Matrix left = scale.asDiagonal() * denoised(d.U).transpose() * units.asDiagonal();
  T = denoised(d.V);
  is_exact = T.isIdentity(0) && scales_exactly(left);
  const Matrix all_A = linalg::denoised_product(left, linalg::denoised_product(m.A, T));
  const Matrix all_B = linalg::denoised_product(left, m.B), all_Bw = linalg::denoised_product(left, m.Bw);
  A = all_A.topRows(rank);
  B = all_B.topRows(rank);
  Bw = all_Bw.topRows(rank);
  static_A = all_A.bottomRows(n - rank);
  static_B = all_B.bottomRows(n - rank);
  static_Bw = all_Bw.bottomRows(n - rank);
  rows = left.topRows(rank);
  static_rows_map = left.bottomRows(n - rank);
  free_part = Matrix::Zero(n, n - rank);
  free_part.bottomRows(n - rank).setIdentity();
}

bool StaticRows::share_disturbances(const LineForm& W) const {
  const auto enters = [](const Matrix& entries, const Matrix& columns, Index j) {
    return !linalg::product(entries, columns.col(j)).isZero(0);
  };
  bool any_dynamic = false, any_static = false, both = false;
  for (const Matrix* columns : {&W.G, &W.M}) {
    for (Index j = 0; j < columns->cols(); ++j) {
      const bool dynamic = enters(Bw, *columns, j), fixed = enters(static_Bw, *columns, j);
      any_dynamic = any_dynamic || dynamic;
      any_static = any_static || fixed;
      both = both || (dynamic && fixed);
    }
  }
  return both || (W.constraints() > 0 && any_dynamic && any_static);
}

}  // namespace cordon::estimators
