// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/tube_membership/membership.hpp"

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_elimination.hpp"
#include "cordon/solvers/boxed_program.hpp"

namespace cordon::diagnosers {

namespace {

/// The proof about the rows that are left as one about all rows.
Certificate traced(const LinesEliminated& rest, const Certificate& own) {
  if (own.kind == Certificate::Kind::farkas) {
    return {own.kind, linalg::transposed_product(rest.rows, own.data), own.margin};
  }
  const Vector xi =
      own.kind == Certificate::Kind::point ? own.data : Vector(Vector::Zero(rest.set.generators()));
  Vector both(rest.lines_offset.size() + xi.size());
  both << rest.lines_offset + linalg::product(rest.lines_by_factors, xi), xi;
  return {Certificate::Kind::point, std::move(both), own.margin};
}

}  // namespace

Answer membership(const designers::OutputTube& tube, VectorIn u, VectorIn y, Certificate* why) {
  const LineForm Y = tube.at(u);
  const Index m = Y.constraints(), p = Y.dim();
  Matrix S(m + p, Y.lines()), A(m + p, Y.generators());
  S << Y.S, Y.M;
  A << Y.A, Y.G;
  Vector b(m + p), magnitude(m + p);
  b << Y.b, y - Y.c;
  const Matrix size = u.cwiseAbs();
  magnitude << tube.b.cwiseAbs() + linalg::product(tube.Omega.cwiseAbs(), size),
      y.cwiseAbs() + tube.c.cwiseAbs() + linalg::product(tube.H.cwiseAbs(), size);
  if (!magnitude.allFinite())
    throw Error(Errc::not_finite, "inputs and outputs overflow; scale the problem");
  const Index lines = S.cols(), factors = A.cols();
  const Vector terms = magnitude + A.cwiseAbs().rowwise().sum();
  const LinesEliminated rest = eliminate_lines_traced(
      {Matrix(0, lines), Matrix(0, factors), Vector(0), std::move(S), std::move(A), std::move(b)},
      magnitude);
  Certificate proof;
  const Vector row_terms = linalg::product(rest.rows.cwiseAbs(), terms);
  Answer empty = BoxedProgram(rest.set.A, rest.set.b, {row_terms, designers::row_noise * row_terms})
                     .is_empty(&proof);
  if (empty == Answer::no && rest.vanished > 0)
    empty = Answer::unknown;  // what vanished is not shown to hold
  if (why) *why = empty == Answer::unknown ? Certificate{} : traced(rest, proof);
  return negate(empty);
}

}  // namespace cordon::diagnosers
