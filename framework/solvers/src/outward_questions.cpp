// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/outward_questions.hpp"

#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_bounds.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/exact_questions.hpp"
#include "cordon/solvers/set_questions.hpp"

namespace cordon::outward {

namespace {

/// Rational arithmetic takes milliseconds up to here.
constexpr Index exact_columns = 60;

/// X with lines bounded where that is proven, and a superset of it in which the other lines meet no
/// row.
struct Relaxed {
  LineForm set;     ///< equal to X
  LineForm larger;  ///< X ⊆ larger ⊕ M R^l, without lines; rows that involve lines read 0 = 0
  std::vector<Index> forgotten;

  explicit Relaxed(const LineForm& X) : set(bound_lines(X).set), larger(set) {
    for (Index i = 0; i < set.constraints(); ++i) {
      if (set.lines() == 0 || set.S.row(i).isZero(0)) continue;
      larger.A.row(i).setZero();
      larger.b[i] = 0;
      forgotten.push_back(i);
    }
    larger.M.resize(set.dim(), 0);
    larger.S.resize(set.constraints(), 0);
  }

  /// h(d) with the rows that were forgotten, where there are any and rational arithmetic can take
  /// them all; else +inf. A set that is empty by the last bits of its numbers gives +inf too:
  /// emptiness is left to the question for it, with its margin.
  double exact_support(VectorIn d) const {
    if (forgotten.empty() || set.lines() + set.generators() > exact_columns ||
        set.constraints() > exact_columns)
      return infinity;
    const double h = exact::support(set, d).upper;
    return h == -infinity ? infinity : h;
  }

  bool bounded_along(VectorIn d) const {
    for (Index j = 0; j < set.lines(); ++j) {
      if ((set.M.col(j).array() != 0 && d.array() != 0).any()) return false;
    }
    return true;
  }

  /// Rows that were forgotten have no multiplier.
  void complete(Certificate& why) const {
    for (const Index i : forgotten) {
      if (i < why.data.size()) why.data[i] = 0;
    }
  }
};

bool is_unconstrained_box(const LineForm& Y) {
  if (Y.constraints() > 0) return false;
  for (const Matrix* columns : {&Y.G, &Y.M}) {
    for (Index j = 0; j < columns->cols(); ++j) {
      if ((columns->col(j).array() != 0).count() > 1) return false;
    }
  }
  return true;
}

/// hull ⊆ Y for such a Y.
bool holds(const LineForm& Y, const Box& hull) {
  for (Index i = 0; i < Y.dim(); ++i) {
    if (Y.lines() > 0 && !Y.M.row(i).isZero(0)) continue;
    const bool one = (Y.G.row(i).array() != 0).count() == 1;
    const double radius = Y.generators() == 0 ? 0.0
                          : one               ? Y.G.row(i).cwiseAbs().maxCoeff()
                                : std::max(0.0, rounding::norm_1(Y.G.row(i).transpose()).lower);
    const double above = radius == 0 ? Y.c[i] : rounding::down(Y.c[i] + radius);
    const double below = radius == 0 ? Y.c[i] : rounding::up(Y.c[i] - radius);
    if (!(hull.upper[i] <= above) || !(hull.lower[i] >= below)) return false;
  }
  return true;
}

}  // namespace

double support(const LineForm& X, VectorIn d, Certificate* why) {
  if (d.size() != X.dim())
    throw Error(Errc::dimension, "support: the direction has another dimension than the set");
  if (!d.allFinite())
    throw Error(Errc::not_finite, "support: the direction has a NaN or infinite entry");
  const Relaxed relaxed(X);
  if (const double h = relaxed.exact_support(d); h < infinity) {
    if (why) *why = {};
    return h;
  }
  if (!relaxed.bounded_along(d))
    return cordon::is_empty(X, why) == Answer::yes ? -infinity : infinity;
  const double h = cordon::support(relaxed.larger, d, why);
  if (why) relaxed.complete(*why);
  return h;
}

Box interval_hull(const LineForm& X, std::vector<Certificate>* why) {
  const Relaxed relaxed(X);
  Box hull = cordon::interval_hull(relaxed.larger, why);
  for (std::size_t k = 0; why && k < why->size(); ++k) relaxed.complete((*why)[k]);
  if (relaxed.set.lines() == 0 || X.dim() == 0 || hull.is_empty()) return hull;
  for (Index i = 0; i < X.dim(); ++i) {
    if (relaxed.set.M.row(i).isZero(0)) continue;
    const Vector d = Vector::Unit(X.dim(), i);
    hull.lower[i] = -relaxed.exact_support(-d);
    hull.upper[i] = relaxed.exact_support(d);
    if (why)
      (*why)[static_cast<std::size_t>(2 * i)] = (*why)[static_cast<std::size_t>(2 * i + 1)] = {};
  }
  return cordon::is_empty(X) == Answer::yes ? Box::empty(X.dim()) : hull;
}

Answer is_subset(const LineForm& X, const LineForm& Y, Certificate* why) {
  if (X.dim() != Y.dim()) throw Error(Errc::dimension, "is_subset: the dimensions differ");
  if (cordon::is_empty(X, why) == Answer::yes) return Answer::yes;
  if (is_unconstrained_box(Y) && holds(Y, outward::interval_hull(X))) return Answer::yes;
  const Relaxed left(X), right(Y);
  if (left.set.lines() + right.set.lines() > 0) return Answer::unknown;
  return cordon::is_subset(left.set, right.set, why) == Answer::no ? Answer::no : Answer::unknown;
}

}  // namespace cordon::outward
