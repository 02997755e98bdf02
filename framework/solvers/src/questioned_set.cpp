// SPDX-License-Identifier: GPL-3.0-or-later
// Supports and emptiness of a set without its lines, with proofs about the set as it was given.
#include "questioned_set.hpp"

#include <cmath>

#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/certificate.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "rational_effort.hpp"

namespace cordon {

namespace {

std::optional<LinesEliminated> without_lines(const LineForm& X, VectorIn magnitude) {
  if (X.lines() == 0) return std::nullopt;
  return eliminate_lines_traced(X, magnitude);
}

}  // namespace

Questioned::Questioned(const LineForm& form, VectorIn magnitude)
    : eliminated(without_lines(form, magnitude)),
      X(eliminated ? eliminated->set : form),
      program(X.A, X.b, {eliminated ? eliminated->row_magnitude : Vector(magnitude), Vector(0)}) {}

bool Questioned::unbounded_along(VectorIn d) const {
  for (Index j = 0; j < X.lines(); ++j) {
    if (std::abs(X.M.col(j).dot(d)) > 1e-14 * X.M.col(j).cwiseAbs().dot(d.cwiseAbs())) return true;
  }
  return false;
}

double Questioned::support(const LineForm& whole, VectorIn d, Certificate* why) {
  if (why) *why = {};
  if (unbounded_along(d)) return beyond(whole, why);
  gradient = linalg::transposed_product(X.G, d);
  if (!gradient.allFinite()) return beyond(whole, why);  // an overflow
  if (eliminated) return support_through_lines(whole, d, why);
  return support_of_gradient(rounding::dot(d, X.c).upper,
                             rounding::product_error(X.G.transpose(), d).sum(), why);
}

double Questioned::support_along_axis(const LineForm& whole, Index i, double sign,
                                      Certificate* why) {
  if (eliminated) return support(whole, sign * Vector::Unit(X.dim(), i), why);
  gradient = sign * X.G.row(i);
  return support_of_gradient(sign * X.c[i], 0, why);
}

/// Nothing bounds the set along a direction: +inf, unless it is empty.
double Questioned::beyond(const LineForm& whole, Certificate* why) {
  Certificate proof;
  if (cordon::is_empty(whole, &proof) != Answer::yes) return infinity;
  if (why) *why = std::move(proof);
  return -infinity;
}

Answer Questioned::is_empty(Certificate* why) {
  Certificate own;
  const Answer answer = program.is_empty(&own);
  if (why)
    *why = answer == Answer::no ? point(own) : answer == Answer::yes ? farkas(own) : Certificate{};
  return answer;
}

Certificate Questioned::candidate() {
  const auto xi = program.central_point();
  return xi ? point({Certificate::Kind::point, *xi, 0}) : Certificate{};
}

Vector Questioned::with_lines(const Vector& xi) const {
  if (!eliminated) return xi;
  Vector both(eliminated->lines_offset.size() + xi.size());
  both << eliminated->lines_offset + linalg::product(eliminated->lines_by_factors, xi), xi;
  return both;
}

double Questioned::support_of_gradient(double at_center, double gradient_error, Certificate* why) {
  program.upper_bound(gradient, bound);
  if (bound.upper == -infinity) {
    if (why) *why = {Certificate::Kind::farkas, bound.y, farkas_margin(X.A, X.b, bound.y)};
    return -infinity;
  }
  const double h = rounding::up(rounding::up(at_center + bound.upper) + gradient_error);
  if (why) *why = {Certificate::Kind::dual, bound.y, h};
  return h;
}

/// A bound is what rational arithmetic makes of the multipliers.
double Questioned::support_through_lines(const LineForm& whole, VectorIn d, Certificate* why) {
  program.upper_bound(gradient, bound);
  const bool affordable = has_few_lines(whole.S, whole.A);
  if (bound.upper == -infinity) {
    Certificate proof =
        farkas({Certificate::Kind::farkas, bound.y, farkas_margin(X.A, X.b, bound.y)});
    if (!(affordable && proves_empty(whole, proof))) return beyond(whole, why);
    if (why) *why = std::move(proof);
    return -infinity;
  }
  Vector y = linalg::transposed_product(eliminated->rows, bound.y) -
             linalg::transposed_product(eliminated->outputs, d);
  const auto proven = affordable ? proven_support(whole, d, y) : std::nullopt;
  if (!proven) return beyond(whole, why);
  if (why) *why = {Certificate::Kind::dual, std::move(y), *proven};
  return *proven;
}

Certificate Questioned::farkas(Certificate own) const {
  if (eliminated) own.data = linalg::transposed_product(eliminated->rows, own.data);
  return own;
}

Certificate Questioned::point(const Certificate& own) const {
  const Vector xi =
      own.kind == Certificate::Kind::structure ? Vector(Vector::Zero(X.generators())) : own.data;
  return {Certificate::Kind::point, with_lines(xi), own.margin};
}

}  // namespace cordon
