// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/rounding_room.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "cordon/core/linalg.hpp"
#include "cordon/core/tolerances.hpp"

namespace cordon::estimators {

namespace {

constexpr double share = tolerances::product_noise;
constexpr double negligible = 1e-10;  // of a half width
constexpr double cancelled = 0.25;

}  // namespace

RoundingRoom::RoundingRoom(const SetBackend& backend, VectorIn sum, VectorIn terms,
                           VectorIn half_widths)
    : backend_(backend) {
  std::vector<Index> rows;
  for (Index i = 0; i < sum.size() && backend.info().rounding == Rounding::nominal; ++i) {
    const bool stands = std::abs(sum[i]) >= cancelled * terms[i],
               is_small = share * terms[i] <= negligible * half_widths[i];
    if (!stands && !is_small)
      rows.push_back(i);  // NaN, of terms that overflow, is left to the backend's refusal
  }
  make(rows, terms);
}

RoundingRoom::RoundingRoom(const SetBackend& backend, VectorIn terms) : backend_(backend) {
  std::vector<Index> rows;
  for (Index i = 0; i < terms.size(); ++i) {
    if (terms[i] > 0) rows.push_back(i);
  }
  make(rows, terms);
}

void RoundingRoom::make(const std::vector<Index>& rows, VectorIn terms) {
  columns_ = Matrix::Zero(terms.size(), static_cast<Index>(rows.size()));
  if (rows.empty()) return;
  for (Index column = 0; column < columns_.cols(); ++column) {
    const Index i = rows[static_cast<std::size_t>(column)];
    columns_(i, column) = share * terms[i];
  }
  const Vector ones = Vector::Ones(columns_.cols());
  factors_ = backend_.box({-ones, ones});
}

bool RoundingRoom::may_be_needed(double most, double least_width) {
  return !(share * most <= negligible * least_width);
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
  if (!X.backend().info().exact_exchange) return X.interval_hull();
  const LineForm form = X.line_form();
  const Vector widths = half_widths(form, Matrix::Identity(form.dim(), form.dim()));
  return {form.c - widths, form.c + widths};
}

double row_norm(const Matrix& A) {
  return A.size() ? A.cwiseAbs().rowwise().sum().maxCoeff() : 0.0;
}

Vector half_widths(const LineForm& X, MatrixIn T) {
  Vector widths = linalg::product(T, X.G).cwiseAbs().rowwise().sum();
  const Vector lines = linalg::product(T, X.M).cwiseAbs().rowwise().sum();
  for (Index i = 0; i < widths.size(); ++i) {
    if (lines[i] > 0) widths[i] = infinity;
  }
  return widths;
}

}  // namespace cordon::estimators
