// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference.hpp"

#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/core/line_form.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/set_questions.hpp"

namespace mutants {

Answer LineSet::do_is_empty(Certificate* why) const { return cordon::is_empty(form_, why); }
Answer LineSet::do_contains(VectorIn x, Certificate* why) const {
  return cordon::contains(form_, x, why);
}
Answer LineSet::do_is_bounded() const { return cordon::is_bounded(form_); }
double LineSet::do_support(VectorIn d, Certificate* why) const {
  return cordon::support(form_, d, why);
}
Box LineSet::do_interval_hull(std::vector<Certificate>* why) const {
  return cordon::interval_hull(form_, why);
}

LineForm Reference::predicted(const Set& X, const PredictionArgs& p) {
  LineForm sum = cordon::affine_map(form(X), p.A, p.f);
  for (const Term& term : p.terms) {
    sum = minkowski_sum(sum, cordon::affine_map(form(*term.set), term.T, Vector::Zero(p.A.rows())));
  }
  return sum;
}

LineForm Reference::corrected(const Set& X, MatrixIn C, VectorIn z, MatrixIn T, const Set& noise) {
  return cordon::intersection(form(X), C, cordon::affine_map(form(noise), -T, z));
}

bool Reference::fits(const LineForm& X, Budget budget) {
  return X.generators() <= budget.generators && X.constraints() <= budget.constraints;
}

LineForm Reference::boxed(const LineForm& X, Budget budget) {
  Box hull = cordon::interval_hull(X);
  // ∅ takes a row; where the budget has none, any set encloses it
  if (hull.is_empty()) return budget.constraints > 0 ? make_empty(X.dim()) : make_point(X.c);
  for (Index i = 0; i < hull.dim(); ++i) {
    if (std::isfinite(hull.lower[i]) && std::isfinite(hull.upper[i])) continue;
    hull.lower[i] = -infinity;
    hull.upper[i] = infinity;
  }
  LineForm box = make_box(hull);
  if (box.generators() > budget.generators) {
    throw Error(Errc::invalid, "a box in dimension " + std::to_string(X.dim()) + " needs " +
                                   std::to_string(box.generators()) +
                                   " generators, the budget has " +
                                   std::to_string(budget.generators));
  }
  return box;
}

SetBackend::Made Reference::do_correct(const Set& X, const CorrectionArgs& c) const {
  return {make(corrected(X, c.C, c.z, c.noise.T, *c.noise.set)), Tightness::exact};
}

// A x = mid(A) x + Δ x with |Δ x| ≤ rad(A) |x|, and |x| is bounded by the hull
SetBackend::Made Reference::do_interval_map(const Set& X, const IntervalMatrix& A) const {
  const Index m = A.rows(), n = A.cols();
  const LineForm mapped = cordon::affine_map(form(X), A.center, Vector::Zero(m));
  if (A.is_exact()) return {make(mapped), Tightness::exact};
  const Box hull = cordon::interval_hull(form(X));
  if (hull.is_empty()) return {make(make_empty(m)), Tightness::exact};
  Box spread{Vector::Zero(m), Vector::Zero(m)};
  for (Index i = 0; i < m; ++i) {
    double width = 0;
    for (Index j = 0; j < n; ++j) {
      if (A.radius(i, j) > 0)
        width += A.radius(i, j) * std::max(std::abs(hull.lower[j]), std::abs(hull.upper[j]));
    }
    if (width == 0) continue;
    spread.upper[i] = rounding::up(width * (1 + rounding::gamma(2 * n + 2)));
    spread.lower[i] = -spread.upper[i];
  }
  return {make(minkowski_sum(mapped, make_box(spread))), Tightness::outer};
}

SetBackend::Made Reference::do_intersection(const Set& X, MatrixIn R, const Set& Y) const {
  return {make(cordon::intersection(form(X), R, form(Y))), Tightness::exact};
}

SetBackend::Made Reference::do_convex_hull(const Set& X, const Set& Y) const {
  const bool lines = form(X).lines() > 0 || form(Y).lines() > 0;
  return {make(cordon::convex_hull(form(X), form(Y))), lines ? Tightness::outer : Tightness::exact};
}

SetBackend::Made Reference::do_reduce(const Set& X, Budget budget) const {
  if (fits(form(X), budget)) return {};
  return {make(boxed(form(X), budget)), Tightness::outer};
}

}  // namespace mutants
