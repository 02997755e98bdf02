// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/certificate.hpp"

#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"
#include "question_rows.hpp"
#include "rational_effort.hpp"
#include "solvers/rational_system.hpp"

namespace cordon {

namespace {

using namespace rational;
using Kind = Certificate::Kind;

void require_point(const LineForm& X, VectorIn x) {
  check(X, "certificate");
  if (x.size() != X.dim())
    throw Error(Errc::dimension, "certificate: the vector has another dimension than the set");
  if (!x.allFinite())
    throw Error(Errc::not_finite, "certificate: the vector has a NaN or infinite entry");
}

void require_pair(const LineForm& X, const LineForm& Y) {
  check(X, "certificate");
  check(Y, "certificate");
  if (X.dim() != Y.dim()) throw Error(Errc::dimension, "certificate: the dimensions differ");
}

bool proves_empty(const Rows& rows, const Certificate& why) {
  if (why.kind == Kind::structure) {  // a row 0 = b
    for (Index i = 0; i < rows.plus.size(); ++i) {
      if (rows.S.row(i).isZero(0) && rows.A.row(i).isZero(0) && rows.plus[i] != rows.minus[i])
        return true;
    }
    return false;
  }
  if (why.kind != Kind::farkas) return false;
  const auto margin = farkas_margin(System(rows), why.data);
  return margin && sgn(*margin) > 0;
}

bool proves_point(const Rows& rows, const Certificate& why) {
  if (rows.plus.size() == 0) return why.kind == Kind::structure || why.kind == Kind::point;
  return why.kind == Kind::point && has_solution_near(System(rows), why.data);
}

}  // namespace

bool proves_empty(const LineForm& X, const Certificate& why) {
  check(X, "certificate");
  return proves_empty(rows_of(X), why);
}

bool is_quickly_proven_empty(const LineForm& X) { return has_few_lines(X.S, X.A); }

bool proves_not_empty(const LineForm& X, const Certificate& why) {
  check(X, "certificate");
  return proves_point(rows_of(X), why);
}

bool proves_contains(const LineForm& X, VectorIn x, const Certificate& why) {
  require_point(X, x);
  return proves_point(rows_of_point(X, x), why);
}

bool proves_excludes(const LineForm& X, VectorIn x, const Certificate& why) {
  require_point(X, x);
  return proves_empty(rows_of_point(X, x), why);
}

bool proves_disjoint(const LineForm& X, const LineForm& Y, const Certificate& why) {
  require_pair(X, Y);
  return proves_empty(rows_of_intersection(X, Y), why);
}

bool proves_meet(const LineForm& X, const LineForm& Y, const Certificate& why) {
  require_pair(X, Y);
  return proves_point(rows_of_intersection(X, Y), why);
}

std::optional<double> proven_support(const LineForm& X, VectorIn d, VectorIn y) {
  require_point(X, d);
  const RationalVector direction = exact(d);
  RationalVector t(as_size(X.lines())), g(as_size(X.generators()));
  for (Index i = 0; i < X.dim(); ++i) {
    if (d[i] == 0) continue;
    for (Index j = 0; j < X.lines(); ++j) t[as_size(j)] += direction[as_size(i)] * exact(X.M(i, j));
    for (Index j = 0; j < X.generators(); ++j)
      g[as_size(j)] += direction[as_size(i)] * exact(X.G(i, j));
  }
  const auto bound = dual_bound(System(rows_of(X)), t, g, y);
  if (!bound) return std::nullopt;
  return enclose(dot(direction, exact(X.c)) + *bound).upper;
}

bool proves_support(const LineForm& X, VectorIn d, double bound, const Certificate& why) {
  require_point(X, d);
  if (bound == infinity) return true;
  if (why.kind == Kind::farkas) return proves_empty(X, why);
  if (why.kind != Kind::dual && why.kind != Kind::structure) return false;
  const auto proven = proven_support(
      X, d, why.kind == Kind::structure ? Vector(Vector::Zero(X.constraints())) : why.data);
  return proven && *proven <= bound;
}

bool has_lineality(const LineForm& X) {
  check(X, "lineality");
  if (X.lines() == 0) return false;
  const auto rank_of = [&](const Matrix& M) {
    Index rank = 0;
    solve(exact_matrix(M), RationalVector(as_size(M.rows())), Vector::Ones(M.cols()), &rank);
    return rank;
  };
  Matrix both(X.constraints() + X.dim(), X.lines());
  both << X.S, X.M;
  return rank_of(both) > rank_of(X.S);
}

}  // namespace cordon
