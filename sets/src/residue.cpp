// SPDX-License-Identifier: GPL-3.0-or-later
#include "residue.hpp"

#include <limits>

#include "small_products.hpp"
#include "tracked_form.hpp"

namespace cordon::sets {

namespace {

/// K is overwritten.
bool is_positive_definite(Matrix& K) {
  const Index m = K.rows();
  for (Index k = 0; k < m; ++k) {
    if (!(K(k, k) > 0) || !(K(k, k) <= std::numeric_limits<double>::max())) return false;
    const double* const column = &K(0, k);
    for (Index j = k + 1; j < m; ++j) {
      const double factor = column[j] / column[k];
      double* const to = &K(0, j);
      for (Index i = j; i < m; ++i) to[i] -= factor * column[i];
    }
  }
  return true;
}

/// Rows of [G; A] with noise, as columns, in units of `noise` / `nominal_margin`, and of them only every `stride`-th factor.
Matrix noisy_rows(const LineForm& X, const Vector& noise, Index count, Index stride) {
  const Index n = X.dim(), taken = (X.generators() + stride - 1) / stride;
  Matrix columns(taken, count);
  Index next = 0;
  for (Index i = 0; i < noise.size(); ++i) {
    if (!(noise[i] > 0)) continue;
    const double scale = nominal_margin / noise[i];
    const double* const from = i < n ? &X.G(i, 0) : &X.A(i - n, 0);
    const Index step = stride * (i < n ? n : X.constraints());
    double* const to = &columns(0, next++);
    for (Index j = 0; j < taken; ++j) to[j] = scale * from[j * step];
  }
  return columns;
}

/// Does {Hᵀξ : ‖ξ‖₂ ≤ 1} hold the unit ball?
bool holds_unit_ball(const Matrix& H) {
  if (H.rows() < H.cols()) return false;
  Matrix K = inner_products(H, H);
  K.diagonal().array() -= 1;
  return is_positive_definite(K);
}

/// Does {[G; A]ξ : ‖ξ‖₂ ≤ 1} hold the ellipsoid with the half axes `noise` / `nominal_margin`? Rows without noise do not count.
/// With a part of the factors it is smaller, so that what holds for some, as it does nearly always, holds for all.
bool is_wide(const LineForm& X, const Vector& noise) {
  const Index g = X.generators(), count = (noise.array() > 0).count();
  if (count == 0 || g == 0) return count == 0;
  const Index stride = g / (count + 8);
  return (stride > 1 && holds_unit_ball(noisy_rows(X, noise, count, stride))) || holds_unit_ball(noisy_rows(X, noise, count, 1));
}

}  // namespace

LineForm with_residue(const LineForm& X, const Vector& row_terms, const Vector& state_terms) {
  const Index n = X.dim(), m = X.constraints();
  Vector terms(n + m);
  terms << state_terms, row_terms.cwiseMax(X.b.cwiseAbs().cwiseMax(X.A.cwiseAbs().rowwise().sum()));
  for (Index i = 0; i < m; ++i) {
    if (!X.S.row(i).isZero(0)) terms[n + i] = row_terms[i];  // lines satisfy such a row
  }
  if (is_wide(X, nominal_noise * terms)) return X;
  return with_radii(X, nominal_noise * row_terms, nominal_noise * state_terms);
}

}  // namespace cordon::sets
