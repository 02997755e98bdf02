// SPDX-License-Identifier: GPL-3.0-or-later
#include "question_rows.hpp"

#include "cordon/core/linalg.hpp"

namespace cordon {

rational::Rows rows_of(const LineForm& X) { return {X.S, X.A, X.b, Vector::Zero(X.b.size())}; }

rational::Rows rows_of_point(const LineForm& X, VectorIn x) {
  const Index n = X.dim(), m = X.constraints();
  rational::Rows rows{Matrix(m + n, X.lines()), Matrix(m + n, X.generators()), Vector(m + n),
                      Vector::Zero(m + n)};
  rows.S << X.S, X.M;
  rows.A << X.A, X.G;
  rows.plus << X.b, x;
  rows.minus.tail(n) = X.c;
  return rows;
}

rational::Rows rows_of_intersection(const LineForm& X, const LineForm& Y) {
  const Index n = X.dim(), m = X.constraints() + Y.constraints();
  rational::Rows rows{Matrix(m + n, X.lines() + Y.lines()),
                      Matrix(m + n, X.generators() + Y.generators()), Vector(m + n),
                      Vector::Zero(m + n)};
  rows.S.topRows(m) = linalg::block_diagonal(X.S, Y.S);
  rows.A.topRows(m) = linalg::block_diagonal(X.A, Y.A);
  rows.S.bottomRows(n) << X.M, -Y.M;
  rows.A.bottomRows(n) << X.G, -Y.G;
  rows.plus << X.b, Y.b, Y.c;
  rows.minus.tail(n) = X.c;
  return rows;
}

}  // namespace cordon
