// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracked_form.hpp"

#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/sets/interval.hpp"
#include "error_free.hpp"

namespace cordon::sets {

namespace {

/// row -= factor · pivot, entry by entry; errors go to the radius.
template <class Row, class Pivot>
void combine(Row row, double factor, const Pivot& pivot, double& radius) {
  for (Index j = 0; j < row.size(); ++j) {
    if (pivot[j] == 0) continue;
    Tracked entry{row[j], 0};
    entry.subtract_product(factor, pivot[j]);
    row[j] = entry.value;
    radius = plus_up(radius, entry.error);
  }
}

/// The coefficient that was to vanish goes to the radius.
void clear(double& coefficient, double& radius) {
  radius = plus_up(radius, std::abs(coefficient));
  coefficient = 0;
}

void require_finite_radius(const Vector& radius) {
  if (!radius.allFinite())
    throw Error(Errc::not_finite, "a set operation overflows; scale the problem");
}

}  // namespace

TrackedForm::TrackedForm(LineForm X)
    : X_(std::move(X)),
      row_radius_(Vector::Zero(X_.constraints())),
      state_radius_(Vector::Zero(X_.dim())),
      row_terms_(X_.constraints()),
      live_(as_size(X_.constraints()), true),
      free_(as_size(X_.generators()), true) {
  for (Index i = 0; i < rows(); ++i) row_terms_[i] = scale(i);
}

double TrackedForm::scale(Index row) const {
  const double largest = factors() ? X_.A.row(row).cwiseAbs().maxCoeff() : 0.0;
  return std::max(largest, std::abs(X_.b[row]));
}

void TrackedForm::subtract_multiple(Index i, Index row, double factor) {
  combine(X_.A.row(i), factor, X_.A.row(row), row_radius_[i]);
  row_terms_[i] = std::max(row_terms_[i], std::abs(factor) * row_terms_[row]);
  Tracked right{X_.b[i], 0};
  right.subtract_product(factor, X_.b[row]);
  X_.b[i] = right.value;
  row_radius_[i] =
      plus_up(row_radius_[i], plus_up(right.error, times_up(std::abs(factor), row_radius_[row])));
}

void TrackedForm::subtract(Index i, Index row, Index col) {
  if (X_.A(i, col) == 0) return;
  subtract_multiple(i, row, X_.A(i, col) / X_.A(row, col));
  clear(X_.A(i, col), row_radius_[i]);
}

void TrackedForm::subtract_from_state(Index i, Index row, Index col) {
  if (X_.G(i, col) == 0) return;
  // x = c + Gξ and Aξ - b = 0, so that x = (c + f b) + (G - f A)ξ
  const double factor = X_.G(i, col) / X_.A(row, col);
  double& radius = state_radius_[i];
  combine(X_.G.row(i), factor, X_.A.row(row), radius);
  Tracked center{X_.c[i], 0};
  center.add_product(factor, X_.b[row]);
  X_.c[i] = center.value;
  radius = plus_up(radius, plus_up(center.error, times_up(std::abs(factor), row_radius_[row])));
  clear(X_.G(i, col), radius);
}

void TrackedForm::eliminate(Index row, Index col) {
  for (Index i = 0; i < rows(); ++i) {
    if (i != row && is_live(i)) subtract(i, row, col);
  }
  for (Index i = 0; i < X_.dim(); ++i) subtract_from_state(i, row, col);
  drop(row);
  free_[as_size(col)] = false;
}

bool TrackedForm::best_pivot(const std::vector<Index>& among_rows,
                             const std::vector<Index>& among_factors, Index& row,
                             Index& col) const {
  double best = 0;
  for (const Index i : among_rows) {
    if (!is_live(i)) continue;
    const double largest = X_.A.row(i).cwiseAbs().maxCoeff();
    for (const Index j : among_factors) {
      if (free_[as_size(j)] && std::abs(X_.A(i, j)) > best * largest) {
        best = std::abs(X_.A(i, j)) / largest;
        row = i;
        col = j;
      }
    }
  }
  return best > 0;
}

void TrackedForm::drop_vague_rows() {
  for (Index i = 0; i < rows(); ++i) {
    if (!is_live(i) || has_lines(i)) continue;
    const double size = scale(i);
    if (size > 0 && row_radius_[i] <= 1e-9 * size && size > 1e-12 * row_terms_[i]) continue;
    drop(i);
    row_radius_[i] = plus_up(row_radius_[i], size);  // something was forgotten
  }
}

bool TrackedForm::rescale() {
  const Index m = rows(), g = factors();
  Matrix A = X_.A;
  Vector b = X_.b;
  for (Index i = 0; i < m; ++i) {
    if (is_live(i) && !has_lines(i)) continue;
    A.row(i).setZero();
    b[i] = 0;
  }
  const auto unit_box = [](Index n) { return Box{-Vector::Ones(n), Vector::Ones(n)}; };
  const Box left =
      contract(unit_box(g), A, b, row_radius_.asDiagonal().toDenseMatrix(), unit_box(m));
  if (left.is_empty()) return false;
  for (Index j = 0; j < g; ++j) {
    if (!free_[as_size(j)] || (left.lower[j] == -1 && left.upper[j] == 1)) continue;
    const double mid = left.lower[j] / 2 + left.upper[j] / 2;
    const double rad = std::max({0.0, directed::plus(left.upper[j], -mid).upper,
                                 directed::plus(mid, -left.lower[j]).upper});
    const auto rescale_row = [&](double& coefficient, double& constant, double sign,
                                 double& radius) {
      Tracked moved{constant, 0}, scaled;
      moved.add_product(sign * mid, coefficient);
      scaled.add_product(rad, coefficient);
      constant = moved.value;
      coefficient = scaled.value;
      radius = plus_up(radius, plus_up(moved.error, scaled.error));
    };
    for (Index i = 0; i < m; ++i) {
      if (is_live(i)) rescale_row(X_.A(i, j), X_.b[i], -1, row_radius_[i]);
    }
    for (Index i = 0; i < X_.dim(); ++i) rescale_row(X_.G(i, j), X_.c[i], 1, state_radius_[i]);
  }
  return true;
}

LineForm TrackedForm::nominal(std::vector<Index>& row_of, std::vector<Index>& factor_of) const {
  row_of.clear();
  factor_of.clear();
  for (Index i = 0; i < rows(); ++i) {
    if (is_live(i) && !has_lines(i)) row_of.push_back(i);
  }
  for (Index j = 0; j < factors(); ++j) {
    if (free_[as_size(j)]) factor_of.push_back(j);
  }
  const Index m = static_cast<Index>(row_of.size()), g = static_cast<Index>(factor_of.size()),
              n = X_.dim();
  LineForm Y{Matrix(n, 0), Matrix(n, g), X_.c, Matrix(m, 0), Matrix(m, g), Vector(m)};
  for (Index k = 0; k < g; ++k) {
    Y.G.col(k) = X_.G.col(factor_of[as_size(k)]);
    for (Index i = 0; i < m; ++i) Y.A(i, k) = X_.A(row_of[as_size(i)], factor_of[as_size(k)]);
  }
  for (Index i = 0; i < m; ++i) Y.b[i] = X_.b[row_of[as_size(i)]];
  return Y;
}

LineForm TrackedForm::result() const {
  std::vector<Index> row_of, factor_of;
  for (Index i = 0; i < rows(); ++i) {
    if (is_live(i)) row_of.push_back(i);
  }
  for (Index j = 0; j < factors(); ++j) {
    if (free_[as_size(j)]) factor_of.push_back(j);
  }
  const Index m = static_cast<Index>(row_of.size()), g = static_cast<Index>(factor_of.size());
  LineForm Y{X_.M, Matrix(X_.dim(), g), X_.c, Matrix(m, X_.lines()), Matrix(m, g), Vector(m)};
  Vector row_radius(m);
  for (Index k = 0; k < g; ++k) Y.G.col(k) = X_.G.col(factor_of[as_size(k)]);
  for (Index i = 0; i < m; ++i) {
    const Index row = row_of[as_size(i)];
    for (Index k = 0; k < g; ++k) Y.A(i, k) = X_.A(row, factor_of[as_size(k)]);
    Y.S.row(i) = X_.S.row(row);
    Y.b[i] = X_.b[row];
    row_radius[i] = row_radius_[row];
  }
  return with_radii(Y, row_radius, state_radius_);
}

LineForm with_radii(const LineForm& X, const Vector& row_radius, const Vector& state_radius) {
  require_finite_radius(row_radius);
  require_finite_radius(state_radius);
  const Index n = X.dim(), m = X.constraints(), g = X.generators();
  const Index more = (row_radius.array() > 0).count() + (state_radius.array() > 0).count();
  LineForm Y{X.M, Matrix::Zero(n, g + more), X.c, X.S, Matrix::Zero(m, g + more), X.b};
  Y.G.leftCols(g) = X.G;
  Y.A.leftCols(g) = X.A;
  Index column = g;
  for (Index i = 0; i < m; ++i) {
    if (row_radius[i] > 0) Y.A(i, column++) = row_radius[i];
  }
  for (Index i = 0; i < n; ++i) {
    if (state_radius[i] > 0) Y.G(i, column++) = state_radius[i];
  }
  try {
    check(Y, "set operation");
  } catch (const Error& error) {
    throw Error(error.code(), "a set operation overflows; scale the problem");
  }
  return Y;
}

}  // namespace cordon::sets
