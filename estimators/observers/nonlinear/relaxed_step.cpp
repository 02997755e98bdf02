// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/nonlinear/relaxed_step.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/tolerances.hpp"

namespace cordon::estimators {

namespace {

using formulas::AffineExpression;

std::vector<Interval> sides(const std::vector<Box>& boxes) {
  std::vector<Interval> all;
  for (const Box& box : boxes)
    for (Index i = 0; i < box.dim(); ++i) all.push_back({box.lower[i], box.upper[i]});
  return all;
}

void write_row(const std::vector<double>& coefficients, Matrix& rows, Index row) {
  for (std::size_t i = 0; i < coefficients.size(); ++i)
    rows(row, static_cast<Index>(i)) = coefficients[i];
}

}  // namespace

RelaxedStep::RelaxedStep(const SetBackend& backend, std::vector<Enclosure> sets,
                         const std::vector<Box>& hulls)
    : backend_(backend), sets_(std::move(sets)), relaxation_(sides(hulls)) {}

void RelaxedStep::require(const AffineExpression& expression, Interval values) {
  const Interval sum = values - expression.offset;
  if (sum.is_finite()) rows_.push_back({expression.coefficients, sum.lower, sum.upper});
}

double RelaxedStep::room(const Row& row) const {
  if (backend_.info().rounding != Rounding::nominal) return 0;
  double terms = std::max(std::abs(row.lower), std::abs(row.upper));
  for (std::size_t i = 0; i < row.coefficients.size(); ++i)
    terms += std::abs(row.coefficients[i]) * relaxation_.variables()[i].magnitude();
  return tolerances::product_noise * terms;
}

/// All s that are left.
Enclosure RelaxedStep::bounded() const {
  const std::vector<Interval>& variables = relaxation_.variables();
  Enclosure all = sets_.front();
  for (std::size_t i = 1; i < sets_.size(); ++i) all = backend_.product(all, sets_[i]);
  const auto dim = static_cast<Index>(variables.size()), own = all->dim();
  if (own < dim) {
    Box lifted = Box::space(dim - own);
    for (Index i = 0; i < lifted.dim(); ++i) {
      lifted.lower[i] = variables[as_size(own + i)].lower;
      lifted.upper[i] = variables[as_size(own + i)].upper;
    }
    all = backend_.product(all, backend_.box(lifted));
  }
  std::vector<Row> rows = rows_;
  for (const auto& [coefficients, bound] : relaxation_.inequalities()) {
    const double least = relaxation_.range({coefficients, {0, 0}}).lower;
    if (std::isfinite(least)) rows.push_back({coefficients, std::min(least, bound), bound});
  }
  if (rows.empty()) return all;
  Matrix H = Matrix::Zero(static_cast<Index>(rows.size()), dim);
  Box bounds = Box::space(H.rows());
  for (Index i = 0; i < H.rows(); ++i) {
    const Row& row = rows[as_size(i)];
    write_row(row.coefficients, H, i);
    bounds.lower[i] = row.lower - room(row);
    bounds.upper[i] = row.upper + room(row);
  }
  return backend_.intersection(all, H, backend_.box(bounds));
}

Enclosure RelaxedStep::image(std::span<const AffineExpression> expressions) const {
  const Enclosure all = bounded();
  const auto count = static_cast<Index>(expressions.size());
  Matrix T = Matrix::Zero(count, all->dim());
  Vector center(count), radius(count);
  for (Index i = 0; i < count; ++i) {
    const AffineExpression& expression = expressions[as_size(i)];
    write_row(expression.coefficients, T, i);
    const Interval offset = expression.offset;
    center[i] = 0.5 * offset.lower + 0.5 * offset.upper;
    radius[i] = std::max({0.0, directed::plus(offset.upper, -center[i]).upper,
                          directed::plus(center[i], -offset.lower).upper});
  }
  const Matrix unit = Matrix::Identity(count, count);
  const Enclosure rest = backend_.box({-radius, radius});
  const Term terms[] = {{unit, rest}};
  return backend_.predict(all, {T, center, terms});
}

}  // namespace cordon::estimators
