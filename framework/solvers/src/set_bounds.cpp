// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of sets: support values from above and from below, interval hulls.
#include <cmath>
#include <utility>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/certificate.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "question_rows.hpp"
#include "questioned_set.hpp"
#include "rational_effort.hpp"
#include "solvers/rational_system.hpp"

namespace cordon {

namespace {

/// A step of this length towards the middle gives slack in every coordinate.
constexpr double step_inward = 1e-7;

/// dᵀx for x = c + Mδ + Gξ, rounded down.
double value_at(const LineForm& X, VectorIn d, const rational::RationalVector& both) {
  rational::Rational sum = rational::dot(rational::exact(d), rational::exact(X.c));
  for (Index j = 0; j < X.lines() + X.generators(); ++j) {
    const Vector column = j < X.lines() ? X.M.col(j) : X.G.col(j - X.lines());
    sum += both[static_cast<std::size_t>(j)] *
           rational::dot(rational::exact(d), rational::exact(column));
  }
  return rational::enclose(sum).lower;
}

/// No bound of rounding errors covers the elimination of lines: the proposed points are moved onto
/// the rows exactly.
double lower_support_through_lines(const LineForm& X, VectorIn d) {
  check(X, "lower_support");
  if (!is_small(X.S, X.A)) return -infinity;
  if (!proven_support(X, d, Vector::Zero(X.constraints())))
    return is_empty(X) == Answer::no ? infinity : -infinity;
  Questioned q(X);
  const BoxedProgram::Bound bound = q.program.maximum(linalg::transposed_product(q.X.G, d));
  if (!bound.xi) return -infinity;
  const rational::System rows(rows_of(X));
  if (const auto point = rational::solution_near(rows, q.with_lines(*bound.xi)))
    return value_at(X, d, *point);
  const auto center = q.program.central_point();
  if (!center) return -infinity;
  const auto point = rational::solution_near(
      rows, q.with_lines((1 - step_inward) * *bound.xi + step_inward * *center));
  return point ? value_at(X, d, *point) : -infinity;
}

bool is_zonotope(const LineForm& X) { return X.lines() == 0 && X.constraints() == 0; }

/// dᵀc + ‖Gᵀd‖₁, with its rounding errors: no program is needed. Unbounded on both sides where it
/// overflows.
Interval support_of_zonotope(const LineForm& X, VectorIn d) {
  const Vector gradient = linalg::transposed_product(X.G, d);
  if (!gradient.allFinite()) return {-infinity, infinity};
  const Interval h = rounding::add(rounding::dot(d, X.c), rounding::norm_1(gradient));
  const double error = rounding::product_error(X.G.transpose(), d).sum();
  return {rounding::down(h.lower - error), rounding::up(h.upper + error)};
}

/// c ± |G| 1, to the last digit as a program without rows tells it.
Box hull_of_zonotope(const LineForm& X, std::vector<Certificate>* why) {
  const Index n = X.dim();
  Box hull{Vector(n), Vector(n)};
  Vector row;
  for (Index i = 0; i < n; ++i) {
    row = X.G.row(i);
    const double reach = rounding::norm_1(row).upper;
    hull.upper[i] = rounding::up(rounding::up(X.c[i] + reach));
    hull.lower[i] = -rounding::up(rounding::up(reach - X.c[i]));
    if (!why) continue;
    (*why)[static_cast<std::size_t>(2 * i)] = {Certificate::Kind::dual, Vector(0), hull.upper[i]};
    (*why)[static_cast<std::size_t>(2 * i + 1)] = {Certificate::Kind::dual, Vector(0),
                                                   -hull.lower[i]};
  }
  return hull;
}

}  // namespace

double support(const LineForm& X, VectorIn d, Certificate* why) {
  if (d.size() != X.dim())
    throw Error(Errc::dimension, "support: the direction has another dimension than the set");
  if (!d.allFinite())
    throw Error(Errc::not_finite, "support: the direction has a NaN or infinite entry");
  if (is_zonotope(X)) {
    const double h = support_of_zonotope(X, d).upper;
    if (why) *why = {Certificate::Kind::dual, Vector(0), h};
    return h;
  }
  return Questioned(X).support(X, d, why);
}

double lower_support(const LineForm& X, VectorIn d) {
  if (X.lines() > 0) return lower_support_through_lines(X, d);
  if (is_zonotope(X)) return support_of_zonotope(X, d).lower;
  Questioned q(X);
  const Vector g = linalg::transposed_product(q.X.G, d);
  if (!g.allFinite()) return -infinity;  // an overflow
  const BoxedProgram::Bound bound = q.program.maximum(g);
  if (!bound.xi) return -infinity;
  double value = q.program.lower_support(g, *bound.xi);
  if (value ==
      -infinity) {  // a degenerate vertex: a step towards the middle has slack in every coordinate
    if (const auto center = q.program.central_point()) {
      value = q.program.lower_support(g, (1 - step_inward) * *bound.xi + step_inward * *center);
    }
  }
  if (value == -infinity) return value;
  const double gradient_error = rounding::product_error(q.X.G.transpose(), d).sum();
  return rounding::down(rounding::down(rounding::dot(d, q.X.c).lower + value) - gradient_error);
}

Box interval_hull(const LineForm& X, std::vector<Certificate>* why) {
  const Index n = X.dim();
  if (why) why->assign(static_cast<std::size_t>(2 * n), {});
  if (is_zonotope(X)) return hull_of_zonotope(X, why);
  const auto proof = [&](Index i) { return why ? &(*why)[static_cast<std::size_t>(i)] : nullptr; };
  Questioned q(X);
  Box hull = Box::space(n);
  bool asked = false;
  for (Index i = 0; i < n; ++i) {
    if (q.X.lines() > 0 && q.unbounded_along(Vector::Unit(n, i))) continue;
    hull.upper[i] = q.support_along_axis(X, i, 1, proof(2 * i));
    hull.lower[i] = -q.support_along_axis(X, i, -1, proof(2 * i + 1));
    asked = true;
    if (hull.upper[i] == -infinity || hull.lower[i] == infinity) return Box::empty(n);
  }
  if (!asked && n > 0 && is_empty(X) == Answer::yes) return Box::empty(n);
  // Bounds of a set that is flat up to rounding may cross: both are kept, an empty box would need a
  // proof.
  for (Index i = 0; i < n; ++i) {
    if (hull.lower[i] > hull.upper[i]) std::swap(hull.lower[i], hull.upper[i]);
  }
  return hull;
}

}  // namespace cordon
