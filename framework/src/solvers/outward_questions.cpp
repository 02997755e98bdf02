// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/outward_questions.hpp"

#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_bounds.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/set_questions.hpp"

namespace cordon::outward {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// X with lines bounded where that is proven, and a superset of it in which the other lines meet no row.
struct Relaxed {
  LineForm set;     ///< equal to X
  LineForm larger;  ///< X ⊆ larger ⊕ M R^l, without lines; rows that involve lines read 0 = 0
  bool equal = true;

  explicit Relaxed(const LineForm& X) : set(bound_lines(X).set), larger(set) {
    for (Index i = 0; i < set.constraints(); ++i) {
      if (set.lines() == 0 || set.S.row(i).isZero(0)) continue;
      larger.A.row(i).setZero();
      larger.b[i] = 0;
      equal = false;
    }
    larger.M.resize(set.dim(), 0);
    larger.S.resize(set.constraints(), 0);
  }

  Answer is_empty(Certificate* why) const {
    const Answer answer = cordon::is_empty(larger, why);
    if (equal || answer == Answer::yes) return answer;
    LineForm part = set;  // δ = 0
    part.M.resize(set.dim(), 0);
    part.S.resize(set.constraints(), 0);
    return cordon::is_empty(part, why) == Answer::no ? Answer::no : Answer::unknown;
  }

  /// Is dᵀM = 0, without rounding?
  bool bounded_along(VectorIn d) const {
    for (Index j = 0; j < set.lines(); ++j) {
      Index terms = 0;
      for (Index i = 0; i < set.dim(); ++i) terms += d[i] != 0 && set.M(i, j) != 0 ? 1 : 0;
      if (terms > 0) return false;
    }
    return true;
  }
};

/// Is x - c a double in every coordinate?
bool differences_are_exact(VectorIn x, VectorIn c) {
  for (Index i = 0; i < x.size(); ++i) {
    const double s = x[i] - c[i], part = s - x[i];
    if (!std::isfinite(s) || (x[i] - (s - part)) + (-c[i] - part) != 0) return false;
  }
  return true;
}

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

Answer is_empty(const LineForm& X, Certificate* why) {
  if (X.constraints() == 0) return cordon::is_empty(X, why);
  return Relaxed(X).is_empty(why);
}

Answer contains(const LineForm& X, VectorIn x, Certificate* why) {
  if (x.size() != X.dim()) throw Error(Errc::dimension, "contains: the point has another dimension than the set");
  const Index n = X.dim(), m = X.constraints(), g = X.generators();
  const bool exact = differences_are_exact(x, X.c);
  // Else c takes part as the coefficient of a factor θ that a row of its own sets to 1/2: Mδ + Gξ + 2 c θ = x.
  const Index extra = exact ? 0 : 1;
  LineForm point{Matrix(0, X.lines()),
                 Matrix(0, g + extra),
                 Vector(0),
                 Matrix::Zero(m + n + extra, X.lines()),
                 Matrix::Zero(m + n + extra, g + extra),
                 Vector(m + n + extra)};
  point.S.topRows(m) = X.S;
  point.S.middleRows(m, n) = X.M;
  point.A.topLeftCorner(m, g) = X.A;
  point.A.block(m, 0, n, g) = X.G;
  point.b.head(m) = X.b;
  if (exact) {
    point.b.segment(m, n) = x - X.c;
  } else {
    point.A.block(m, g, n, 1) = 2 * X.c;
    point.b.segment(m, n) = x;
    point.A(m + n, g) = 1;
    point.b[m + n] = 0.5;
    if (!point.A.allFinite()) return Answer::unknown;
  }
  return negate(outward::is_empty(point, why));
}

double support(const LineForm& X, VectorIn d, Certificate* why) {
  if (d.size() != X.dim()) throw Error(Errc::dimension, "support: the direction has another dimension than the set");
  if (!d.allFinite()) throw Error(Errc::not_finite, "support: the direction has a NaN or infinite entry");
  const Relaxed relaxed(X);
  if (!relaxed.bounded_along(d)) return relaxed.is_empty(why) == Answer::yes ? -infinity : infinity;
  return cordon::support(relaxed.larger, d, why);
}

Box interval_hull(const LineForm& X, std::vector<Certificate>* why) {
  const Relaxed relaxed(X);
  Box hull = cordon::interval_hull(relaxed.larger, why);
  if (X.dim() > 0 && hull.is_empty()) return hull;
  for (Index i = 0; i < X.dim() && relaxed.set.lines() > 0; ++i) {
    if (relaxed.set.M.row(i).isZero(0)) continue;
    hull.lower[i] = -infinity;
    hull.upper[i] = infinity;
    if (why) (*why)[static_cast<std::size_t>(2 * i)] = (*why)[static_cast<std::size_t>(2 * i + 1)] = {};
  }
  return hull;
}

Answer is_bounded(const LineForm& X) {
  if (X.lines() == 0) return Answer::yes;
  const Relaxed relaxed(X);
  if (relaxed.set.M.isZero(0)) return Answer::yes;
  const Answer empty = relaxed.is_empty(nullptr);
  if (empty == Answer::yes) return Answer::yes;
  return relaxed.equal && empty == Answer::no ? Answer::no : Answer::unknown;
}

LineForm exact_intersection(const LineForm& X, MatrixIn R, const LineForm& Y) {
  if (R.rows() != Y.dim() || R.cols() != X.dim()) throw Error(Errc::dimension, "intersection: the matrix does not fit the sets");
  const Index n = X.dim(), p = Y.dim(), lx = X.lines(), ly = Y.lines(), gx = X.generators(), gy = Y.generators();
  const Index mx = X.constraints(), my = Y.constraints(), rows = mx + my + n + 2 * p, lines = n + p + lx + ly;
  LineForm Z{Matrix::Zero(n, lines),    Matrix::Zero(n, gx + gy),    Vector::Zero(n),
             Matrix::Zero(rows, lines), Matrix::Zero(rows, gx + gy), Vector::Zero(rows)};
  Z.M.leftCols(n).setIdentity();
  Z.S.block(0, n + p, mx, lx) = X.S;
  Z.A.topLeftCorner(mx, gx) = X.A;
  Z.b.head(mx) = X.b;
  Z.S.block(mx, n + p + lx, my, ly) = Y.S;
  Z.A.block(mx, gx, my, gy) = Y.A;
  Z.b.segment(mx, my) = Y.b;
  Index row = mx + my;
  Z.S.block(row, 0, n, n).setIdentity();
  Z.S.block(row, n + p, n, lx) = -X.M;
  Z.A.block(row, 0, n, gx) = -X.G;
  Z.b.segment(row, n) = X.c;
  row += n;
  Z.S.block(row, n, p, p).setIdentity();
  Z.S.block(row, n + p + lx, p, ly) = -Y.M;
  Z.A.block(row, gx, p, gy) = -Y.G;
  Z.b.segment(row, p) = Y.c;
  row += p;
  Z.S.block(row, 0, p, n) = R;
  Z.S.block(row, n, p, p) = -Matrix::Identity(p, p);
  return Z;
}

Answer is_disjoint(const LineForm& X, const LineForm& Y, Certificate* why) {
  if (X.dim() != Y.dim()) throw Error(Errc::dimension, "is_disjoint: the dimensions differ");
  return outward::is_empty(exact_intersection(X, Matrix::Identity(X.dim(), X.dim()), Y), why);
}

Answer is_subset(const LineForm& X, const LineForm& Y, Certificate* why) {
  if (X.dim() != Y.dim()) throw Error(Errc::dimension, "is_subset: the dimensions differ");
  if (outward::is_empty(X, why) == Answer::yes) return Answer::yes;
  if (is_unconstrained_box(Y) && holds(Y, outward::interval_hull(X))) return Answer::yes;
  const Relaxed left(X), right(Y);
  if (left.set.lines() + right.set.lines() > 0) return Answer::unknown;
  return cordon::is_subset(left.set, right.set, why) == Answer::no ? Answer::no : Answer::unknown;
}

}  // namespace cordon::outward
