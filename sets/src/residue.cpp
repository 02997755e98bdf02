// SPDX-License-Identifier: GPL-3.0-or-later
#include "residue.hpp"

#include <cmath>
#include <limits>

#include "cordon/core/recycled.hpp"
#include "cordon/core/tolerances.hpp"
#include "rows.hpp"
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

/// Rows of [G; A] with noise in units of `noise` / `tolerances::proof_margin`, and of them only
/// every `stride`-th factor.
Rows noisy_rows(const LineForm& X, const Vector& noise, Index count, Index stride) {
  const Index n = X.dim(), taken = (X.generators() + stride - 1) / stride;
  Rows rows = Rows::Zero(count, vectors::padded(taken));
  Index next = 0;
  for (Index i = 0; i < noise.size(); ++i) {
    if (!(noise[i] > 0)) continue;
    const double scale = tolerances::proof_margin / noise[i];
    const double* const from = i < n ? &X.G(i, 0) : &X.A(i - n, 0);
    const Index step = stride * (i < n ? n : X.constraints());
    double* const to = &rows(next++, 0);
    for (Index j = 0; j < taken; ++j) to[j] = scale * from[j * step];
  }
  return rows;
}

/// Does {Hξ : ‖ξ‖₂ ≤ 1} hold the unit ball?
bool holds_unit_ball(const Rows& H) {
  if (H.cols() < H.rows()) return false;
  Matrix K = row_gram(H);
  K.diagonal().array() -= 1;
  return is_positive_definite(K);
}

/// Has every row and coordinate that was computed a factor of its own, in no other row and
/// coordinate, that covers its noise? As those of disturbances are, which come last.
bool have_own_factors(const LineForm& X, const Terms& terms) {
  const Index n = X.dim(), m = X.constraints();
  Index open = (terms.state.array() > 0).count() + (terms.rows.array() > 0).count();
  RecycledVector<bool> covered(static_cast<std::size_t>(n + m), false);
  for (Index j = X.generators() - 1; j >= 0 && open > 0; --j) {
    Index place = -1, entries = 0;
    for (Index i = 0; i < n && entries < 2; ++i) {
      if (X.G(i, j) == 0) continue;
      place = i;
      ++entries;
    }
    for (Index i = 0; i < m && entries < 2; ++i) {
      if (X.A(i, j) == 0) continue;
      place = n + i;
      ++entries;
    }
    if (entries != 1 || covered[static_cast<std::size_t>(place)]) continue;
    const double size = place < n ? X.G(place, j) : X.A(place - n, j);
    const double computed_from = place < n ? terms.state[place] : terms.rows[place - n];
    if (!(computed_from > 0) ||
        !(tolerances::product_noise * computed_from <= tolerances::proof_margin * std::abs(size)))
      continue;
    covered[static_cast<std::size_t>(place)] = true;
    --open;
  }
  return open == 0;
}

/// Does {[G; A]ξ : ‖ξ‖₂ ≤ 1} hold the ellipsoid with the half axes `noise` /
/// `tolerances::proof_margin`? Rows without noise do not count. With a part of the factors it is
/// smaller, so that what holds for some, as it does nearly always, holds for all.
bool is_wide(const LineForm& X, const Vector& noise) {
  const Index g = X.generators(), count = (noise.array() > 0).count();
  if (count == 0 || g == 0) return count == 0;
  const Index stride = g / (count + 8);
  return (stride > 1 && holds_unit_ball(noisy_rows(X, noise, count, stride))) ||
         holds_unit_ball(noisy_rows(X, noise, count, 1));
}

}  // namespace

void take_reach(const Vector& c, const Matrix& G, Vector& sizes) {
  sizes = c.cwiseAbs();
  const Index n = c.size();
  const double* entry = G.data();
  for (Index j = 0; j < G.cols(); ++j) {
    for (Index i = 0; i < n; ++i) sizes[i] += std::abs(*entry++);
  }
}

LineForm with_residue(LineForm X, const Terms& terms) {
  if (have_own_factors(X, terms)) return X;
  const Index n = X.dim(), m = X.constraints();
  Vector noise(n + m);
  noise << terms.state,
      terms.rows.cwiseMax(X.b.cwiseAbs().cwiseMax(X.A.cwiseAbs().rowwise().sum()));
  for (Index i = 0; i < m; ++i) {
    if (X.lines() > 0 && !X.S.row(i).isZero(0))
      noise[n + i] = terms.rows[i];  // lines satisfy such a row
  }
  noise *= tolerances::product_noise;
  if (is_wide(X, noise)) return X;
  return with_radii(X, tolerances::product_noise * terms.rows,
                    tolerances::product_noise * terms.state);
}

Zonotope with_residue(Zonotope Z, const Vector& state) {
  const Index n = Z.dim(), g = Z.generators();
  LineForm X{Matrix(n, 0), std::move(Z.G), std::move(Z.c), Matrix(0, 0), Matrix(0, g), Vector(0)};
  X = with_residue(std::move(X), {Vector(0), state});
  return {std::move(X.c), std::move(X.G)};
}

}  // namespace cordon::sets
