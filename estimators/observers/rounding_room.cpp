// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/rounding_room.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cordon/core/linalg.hpp"
#include "cordon/core/tolerances.hpp"

namespace cordon::estimators {

namespace {

constexpr double share = tolerances::product_noise;
constexpr double negligible = 1e-10;  // of the set
constexpr double cancelled = 0.25;
constexpr double line_length = 1e8;  // of its largest entry

}  // namespace

Thickness::Thickness(const Matrix& N) {
  const Index n = N.rows();
  shares_ = Matrix::Constant(N.cols(), n, infinity);
  if (N.size() == 0 || !N.allFinite()) return;
  const Vector units = N.cwiseAbs().rowwise().maxCoeff();
  const Vector scale = (units.array() > 0).select(units.cwiseInverse(), 1.0);
  const Matrix scaled = scale.asDiagonal() * N;
  const Matrix inverse = linalg::pseudo_inverse(scaled, tolerances::rank);
  // column i of the inverse makes coordinate i alone, if that can be made
  const Matrix made = linalg::product(scaled, inverse);
  for (Index i = 0; i < n; ++i) {
    if ((made.col(i) - Vector::Unit(n, i)).cwiseAbs().maxCoeff() <= tolerances::rank)
      shares_.col(i) = inverse.col(i).cwiseAbs() * scale[i];
  }
  largest_ = shares_.rowwise().sum().maxCoeff();
}

Thickness::Thickness(const LineForm& X, MatrixIn T) : Thickness(columns_of(X, T)) {}

double Thickness::share_of(VectorIn r) const {
  if (shares_.rows() == 0) return (r.array() == 0).all() ? 0 : infinity;
  Vector sums = Vector::Zero(shares_.rows());
  for (Index i = 0; i < r.size(); ++i) {
    if (r[i] != 0) sums += r[i] * shares_.col(i);
  }
  return sums.maxCoeff();
}

Thickness Thickness::of_rows(const std::vector<Index>& rows) const {
  if (shares_.rows() == 0) return *this;
  Thickness some;
  some.shares_ = shares_(Eigen::all, rows);
  some.largest_ = largest_;
  return some;
}

RoundingRoom::RoundingRoom(const SetBackend& backend, VectorIn sum, VectorIn terms,
                           const Thickness& thickness)
    : backend_(backend) {
  RecycledVector<Index> rows;
  for (Index i = 0; i < sum.size() && backend.info().rounding == Rounding::nominal; ++i) {
    // NaN, of terms that overflow, is left to the backend's refusal
    if (!(std::abs(sum[i]) >= cancelled * terms[i])) rows.push_back(i);
  }
  if (!rows.empty()) {
    Vector room = Vector::Zero(sum.size());
    for (const Index i : rows) room[i] = share * terms[i];
    if (thickness.share_of(room) <= negligible) rows.clear();
  }
  make(rows, terms);
}

RoundingRoom::RoundingRoom(const SetBackend& backend, VectorIn terms) : backend_(backend) {
  RecycledVector<Index> rows;
  for (Index i = 0; i < terms.size(); ++i) {
    if (terms[i] > 0) rows.push_back(i);
  }
  make(rows, terms);
}

void RoundingRoom::make(const RecycledVector<Index>& rows, VectorIn terms) {
  columns_ = Matrix::Zero(terms.size(), static_cast<Index>(rows.size()));
  half_widths_ = Vector::Zero(terms.size());
  if (rows.empty()) return;
  Vector factors = Vector::Ones(columns_.cols());
  for (Index column = 0; column < columns_.cols(); ++column) {
    const Index i = rows[static_cast<std::size_t>(column)];
    const bool free = std::isinf(terms[i]) && backend_.info().unbounded;
    half_widths_[i] = share * terms[i];
    columns_(i, column) = free ? 1 : half_widths_[i];
    if (free) factors[column] = infinity;
  }
  factors_ = backend_.box({-factors, factors});
}

bool RoundingRoom::may_be_needed(double most, const Thickness& thickness) {
  return !(share * most * thickness.largest_share() <= negligible);
}

bool RoundingRoom::may_be_needed(VectorIn terms, const Thickness& thickness) {
  return !(share * thickness.share_of(terms) <= negligible);
}

Enclosure RoundingRoom::correct(const Enclosure& X, const CorrectionArgs& measurement) const {
  if (!is_needed()) return backend_.correct(X, measurement);
  Matrix T(columns_.rows(), measurement.noise.T.cols() + columns_.cols());
  T << measurement.noise.T, columns_;
  return backend_.correct(
      X, {measurement.C, measurement.z, {T, backend_.product(measurement.noise.set, factors_)}});
}

Box reach_of(const Set& X) {
  const Complexity size = X.complexity();
  if (size.constraints == 0 && size.lines == 0) return X.interval_hull();
  if (!X.has_exact_form()) return X.interval_hull();
  const LineForm form = X.line_form();
  Vector widths = form.G.cwiseAbs().rowwise().sum();
  for (Index i = 0; i < widths.size(); ++i) {
    if (form.M.cols() > 0 && !form.M.row(i).isZero(0)) widths[i] = infinity;
  }
  return {form.c - widths, form.c + widths};
}

bool excludes_zero(const Box& box, VectorIn sizes) {
  for (Index i = 0; i < box.dim(); ++i) {
    const double slack = tolerances::proof_margin *
                         (sizes[i] + std::max(std::abs(box.lower[i]), std::abs(box.upper[i])));
    if (box.lower[i] > slack || -box.upper[i] > slack) return true;
  }
  return false;
}

double row_norm(const Matrix& A) {
  return A.size() ? A.cwiseAbs().rowwise().sum().maxCoeff() : 0.0;
}

Matrix columns_of(const LineForm& X, MatrixIn T) {
  if (T.rows() == 0 || X.constraints() > 0) return Matrix(T.rows(), 0);
  Matrix N(T.rows(), X.generators() + X.lines());
  N << linalg::product(T, X.G), linalg::product(T, X.M);
  const double size = X.generators() > 0 ? N.leftCols(X.generators()).cwiseAbs().maxCoeff() : 1.0;
  for (Index j = X.generators(); j < N.cols(); ++j) {
    const double entry = N.col(j).cwiseAbs().maxCoeff();
    if (entry > 0) N.col(j) *= line_length * (size > 0 ? size : 1.0) / entry;
  }
  return N;
}

}  // namespace cordon::estimators
