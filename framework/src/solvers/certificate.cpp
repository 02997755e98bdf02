// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/certificate.hpp"

#include <cmath>
#include <gmpxx.h>
#include <optional>
#include <vector>

#include "cordon/core/error.hpp"

namespace cordon {

namespace {

using Rational = mpq_class;
using Kind = Certificate::Kind;

/// Dense matrix by rows.
class RationalMatrix {
 public:
  RationalMatrix(Index rows, Index cols) : rows_(rows), cols_(cols), entries_(static_cast<std::size_t>(rows * cols)) {}
  Index rows() const { return rows_; }
  Index cols() const { return cols_; }
  Rational& operator()(Index i, Index j) { return entries_[static_cast<std::size_t>(i * cols_ + j)]; }
  const Rational& operator()(Index i, Index j) const { return entries_[static_cast<std::size_t>(i * cols_ + j)]; }

  void put(Index row, Index col, MatrixIn block, double sign = 1) {
    for (Index i = 0; i < block.rows(); ++i) {
      for (Index j = 0; j < block.cols(); ++j) {
        if (block(i, j) != 0) (*this)(row + i, col + j) = sign * block(i, j);
      }
    }
  }

 private:
  Index rows_, cols_;
  std::vector<Rational> entries_;
};

using RationalVector = std::vector<Rational>;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

RationalVector exactly(VectorIn x) {
  RationalVector y(at(x.size()));
  for (Index i = 0; i < x.size(); ++i) y[at(i)] = x[i];
  return y;
}

/// K x = r by Gauss-Jordan elimination; x is 0 outside the pivot columns, which are chosen by |entry| · preference (a column of
/// preference 0 is never one). Nothing if the system is inconsistent on those columns. `rank` (may be null) receives the number
/// of pivots.
std::optional<RationalVector> solve(RationalMatrix K, RationalVector r, const Vector& preference, Index* rank = nullptr) {
  std::vector<std::pair<Index, Index>> pivots;
  std::vector<bool> used(at(K.cols()), false);
  for (Index i = 0; i < K.rows(); ++i) {
    Index col = -1;
    double best = 0;
    for (Index j = 0; j < K.cols(); ++j) {
      if (used[at(j)] || preference[j] == 0 || sgn(K(i, j)) == 0) continue;
      const double score = std::abs(K(i, j).get_d()) * preference[j];
      if (col < 0 || score > best) {
        best = score;
        col = j;
      }
    }
    if (col < 0) {
      if (sgn(r[at(i)]) != 0) return std::nullopt;
      continue;
    }
    used[at(col)] = true;
    pivots.emplace_back(i, col);
    const Rational pivot = K(i, col);
    for (Index j = 0; j < K.cols(); ++j) {
      if (sgn(K(i, j)) != 0) K(i, j) /= pivot;
    }
    r[at(i)] /= pivot;
    for (Index k = 0; k < K.rows(); ++k) {
      if (k == i || sgn(K(k, col)) == 0) continue;
      const Rational factor = K(k, col);
      for (Index j = 0; j < K.cols(); ++j) {
        if (sgn(K(i, j)) != 0) K(k, j) -= factor * K(i, j);
      }
      r[at(k)] -= factor * r[at(i)];
    }
  }
  if (rank) *rank = static_cast<Index>(pivots.size());
  RationalVector x(at(K.cols()));
  for (const auto& [row, col] : pivots) x[at(col)] = r[at(row)];
  return x;
}

/// {(δ, ξ) : K (δ, ξ) = r, ‖ξ‖∞ ≤ 1} with the first `lines` columns free.
struct System {
  RationalMatrix K;
  RationalVector r;
  Index lines;

  Index factors() const { return K.cols() - lines; }
};

System rows_of(const LineForm& X) {
  System s{RationalMatrix(X.constraints(), X.lines() + X.generators()), exactly(X.b), X.lines()};
  s.K.put(0, 0, X.S);
  s.K.put(0, X.lines(), X.A);
  return s;
}

System rows_of_point(const LineForm& X, VectorIn x) {
  const Index m = X.constraints(), n = X.dim(), l = X.lines();
  System s{RationalMatrix(m + n, l + X.generators()), exactly(X.b), l};
  s.K.put(0, 0, X.S);
  s.K.put(0, l, X.A);
  s.K.put(m, 0, X.M);
  s.K.put(m, l, X.G);
  for (Index i = 0; i < n; ++i) s.r.push_back(Rational(x[i]) - Rational(X.c[i]));
  return s;
}

System rows_of_intersection(const LineForm& X, const LineForm& Y) {
  const Index m = X.constraints(), p = Y.constraints(), n = X.dim(), l = X.lines() + Y.lines();
  System s{RationalMatrix(m + p + n, l + X.generators() + Y.generators()), exactly(X.b), l};
  const Index left = l, right = l + X.generators();
  s.K.put(0, 0, X.S);
  s.K.put(0, left, X.A);
  s.K.put(m, X.lines(), Y.S);
  s.K.put(m, right, Y.A);
  s.K.put(m + p, 0, X.M);
  s.K.put(m + p, left, X.G);
  s.K.put(m + p, X.lines(), Y.M, -1);
  s.K.put(m + p, right, Y.G, -1);
  for (const Rational& b : exactly(Y.b)) s.r.push_back(b);
  for (Index i = 0; i < n; ++i) s.r.push_back(Rational(Y.c[i]) - Rational(X.c[i]));
  return s;
}

void require(bool fits, const char* what) {
  if (!fits) throw Error(Errc::dimension, std::string("certificate: ") + what);
}

/// y moved onto the equations Lᵀy = t, L the columns of the lines; nothing if they have no solution.
std::optional<RationalVector> multipliers(const System& s, const RationalVector& t, VectorIn y) {
  RationalVector exact = exactly(y);
  RationalMatrix equations(s.lines, s.K.rows());
  RationalVector missing = t;
  bool holds = true;
  for (Index j = 0; j < s.lines; ++j) {
    for (Index i = 0; i < s.K.rows(); ++i) {
      equations(j, i) = s.K(i, j);
      if (sgn(s.K(i, j)) != 0) missing[at(j)] -= s.K(i, j) * exact[at(i)];
    }
    holds = holds && sgn(missing[at(j)]) == 0;
  }
  if (holds) return exact;
  const double largest = y.size() ? y.cwiseAbs().maxCoeff() : 0;
  const Vector preference = y.cwiseAbs().cwiseMax(1e-6 * largest + 1e-300);  // large entries bear a change best
  const auto change = solve(std::move(equations), std::move(missing), preference);
  if (!change) return std::nullopt;
  for (std::size_t i = 0; i < exact.size(); ++i) exact[i] += (*change)[i];
  return exact;
}

Rational product(const RationalVector& x, const RationalVector& y) {
  Rational sum;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (sgn(x[i]) != 0 && sgn(y[i]) != 0) sum += x[i] * y[i];
  }
  return sum;
}

/// ‖g - Aᵀy‖₁ over the factors.
Rational distance(const System& s, const RationalVector& g, const RationalVector& y) {
  Rational sum;
  for (Index j = 0; j < s.factors(); ++j) {
    Rational value = g[at(j)];
    for (Index i = 0; i < s.K.rows(); ++i) {
      if (sgn(s.K(i, s.lines + j)) != 0 && sgn(y[at(i)]) != 0) value -= s.K(i, s.lines + j) * y[at(i)];
    }
    sum += abs(value);
  }
  return sum;
}

bool infeasible(const System& s, const Certificate& why) {
  if (why.kind != Kind::farkas || why.data.size() != s.K.rows() || !why.data.allFinite()) return false;
  const auto y = multipliers(s, RationalVector(at(s.lines)), why.data);
  return y && product(s.r, *y) > distance(s, RationalVector(at(s.factors())), *y);
}

bool feasible(const System& s, const Certificate& why) {
  if (s.K.rows() == 0) return why.kind == Kind::structure || why.kind == Kind::point;
  if (why.kind != Kind::point || why.data.size() != s.K.cols() || !why.data.allFinite()) return false;
  Vector start = why.data, preference(s.K.cols());
  start.tail(s.factors()) = start.tail(s.factors()).cwiseMax(-1.0).cwiseMin(1.0);
  preference.head(s.lines).setConstant(1e6);  // lines have no bound to keep
  preference.tail(s.factors()) = 1 - start.tail(s.factors()).array().abs();
  const RationalVector point = exactly(start);
  RationalVector gap = s.r;
  bool holds = true;
  for (Index i = 0; i < s.K.rows(); ++i) {
    for (Index j = 0; j < s.K.cols(); ++j) {
      if (sgn(s.K(i, j)) != 0) gap[at(i)] -= s.K(i, j) * point[at(j)];
    }
    holds = holds && sgn(gap[at(i)]) == 0;
  }
  if (holds) return true;
  const auto change = solve(s.K, std::move(gap), preference);
  if (!change) return false;
  for (Index j = s.lines; j < s.K.cols(); ++j) {
    if (sgn((*change)[at(j)]) != 0 && abs(point[at(j)] + (*change)[at(j)]) > 1) return false;
  }
  return true;
}

}  // namespace

bool proves_empty(const LineForm& X, const Certificate& why) {
  check(X, "certificate");
  return infeasible(rows_of(X), why);
}

bool proves_not_empty(const LineForm& X, const Certificate& why) {
  check(X, "certificate");
  return feasible(rows_of(X), why);
}

bool proves_contains(const LineForm& X, VectorIn x, const Certificate& why) {
  check(X, "certificate");
  require(x.size() == X.dim() && x.allFinite(), "the point has another dimension than the set");
  return feasible(rows_of_point(X, x), why);
}

bool proves_excludes(const LineForm& X, VectorIn x, const Certificate& why) {
  check(X, "certificate");
  require(x.size() == X.dim() && x.allFinite(), "the point has another dimension than the set");
  return infeasible(rows_of_point(X, x), why);
}

bool proves_disjoint(const LineForm& X, const LineForm& Y, const Certificate& why) {
  check(X, "certificate");
  check(Y, "certificate");
  require(X.dim() == Y.dim(), "the dimensions differ");
  return infeasible(rows_of_intersection(X, Y), why);
}

bool proves_meet(const LineForm& X, const LineForm& Y, const Certificate& why) {
  check(X, "certificate");
  check(Y, "certificate");
  require(X.dim() == Y.dim(), "the dimensions differ");
  return feasible(rows_of_intersection(X, Y), why);
}

bool proves_support(const LineForm& X, VectorIn d, double bound, const Certificate& why) {
  check(X, "certificate");
  require(d.size() == X.dim() && d.allFinite(), "the direction has another dimension than the set");
  if (bound == std::numeric_limits<double>::infinity()) return true;
  if (why.kind == Kind::farkas) return proves_empty(X, why);
  if (why.kind != Kind::dual && why.kind != Kind::structure) return false;
  const Vector y = why.kind == Kind::structure ? Vector(Vector::Zero(X.constraints())) : why.data;
  if (y.size() != X.constraints() || !y.allFinite() || !std::isfinite(bound)) return false;
  const System s = rows_of(X);
  const RationalVector direction = exactly(d);
  RationalVector t(at(X.lines())), g(at(X.generators()));
  for (Index i = 0; i < X.dim(); ++i) {
    if (d[i] == 0) continue;
    for (Index j = 0; j < X.lines(); ++j) t[at(j)] += direction[at(i)] * Rational(X.M(i, j));
    for (Index j = 0; j < X.generators(); ++j) g[at(j)] += direction[at(i)] * Rational(X.G(i, j));
  }
  const auto exact = multipliers(s, t, y);
  return exact && product(direction, exactly(X.c)) + product(s.r, *exact) + distance(s, g, *exact) <= Rational(bound);
}

bool has_lineality(const LineForm& X) {
  check(X, "lineality");
  if (X.lines() == 0) return false;
  const auto rank_of = [&](Index rows) {
    RationalMatrix K(rows, X.lines());
    K.put(0, 0, X.S);
    if (rows > X.constraints()) K.put(X.constraints(), 0, X.M);
    Index rank = 0;
    solve(std::move(K), RationalVector(at(rows)), Vector::Ones(X.lines()), &rank);
    return rank;
  };
  return rank_of(X.constraints() + X.dim()) > rank_of(X.constraints());
}

}  // namespace cordon
