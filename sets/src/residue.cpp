// SPDX-License-Identifier: GPL-3.0-or-later
#include "residue.hpp"

#include <vector>

#include "cordon/core/linalg.hpp"
#include "tracked_form.hpp"

namespace cordon::sets {

namespace {

/// Does {Lξ : ‖ξ‖₂ ≤ 1} hold the ellipsoid with the half axes `noise` / `nominal_margin`? Rows without noise do not count.
bool is_wide(const Matrix& L, const Vector& noise) {
  std::vector<Index> rows;
  for (Index i = 0; i < noise.size(); ++i) {
    if (noise[i] > 0) rows.push_back(i);
  }
  const Index m = static_cast<Index>(rows.size());
  const Vector scale = nominal_margin * noise(rows).cwiseInverse();
  const Matrix H = scale.asDiagonal() * L(rows, Eigen::all);
  const Matrix squares = linalg::product(H, H.transpose()) - Matrix::Identity(m, m);
  return squares.allFinite() && linalg::cholesky(squares);
}

}  // namespace

LineForm with_residue(const LineForm& X, const Vector& row_terms, const Vector& state_terms) {
  const Index n = X.dim(), m = X.constraints();
  Matrix lifted(n + m, X.generators());
  lifted << X.G, X.A;
  Vector terms(n + m);
  terms << state_terms, row_terms.cwiseMax(X.b.cwiseAbs().cwiseMax(X.A.cwiseAbs().rowwise().sum()));
  for (Index i = 0; i < m; ++i) {
    if (!X.S.row(i).isZero(0)) terms[n + i] = row_terms[i];  // lines satisfy such a row
  }
  if (is_wide(lifted, nominal_noise * terms)) return X;
  return with_radii(X, nominal_noise * row_terms, nominal_noise * state_terms);
}

}  // namespace cordon::sets
