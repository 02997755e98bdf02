// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/tube_membership/membership.hpp"

#include <cmath>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_elimination.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/tubes/line_proof.hpp"

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

/// The entries of y that are no NaN.
std::vector<Index> values_of(VectorIn y) {
  std::vector<Index> present;
  for (Index i = 0; i < y.size(); ++i) {
    if (!std::isnan(y[i])) present.push_back(i);
  }
  return present;
}

/// Multipliers of all rows: 0 for those of missing outputs, below m others.
Vector with_rows_of_missing(const Vector& multipliers, Index m, const std::vector<Index>& present,
                            Index outputs) {
  Vector all = Vector::Zero(m + outputs);
  all.head(m) = multipliers.head(m);
  for (std::size_t i = 0; i < present.size(); ++i)
    all[m + present[i]] = multipliers[m + static_cast<Index>(i)];
  return all;
}

}  // namespace

Answer membership(const OutputTube& tube, VectorIn u, VectorIn y, Certificate* why) {
  const LineForm Y = tube.at(u);
  const std::vector<Index> present = values_of(y);
  const Index m = Y.constraints(), p = static_cast<Index>(present.size());
  Matrix S(m + p, Y.lines()), A(m + p, Y.generators());
  S << Y.S, Y.M(present, Eigen::all);
  A << Y.A, Y.G(present, Eigen::all);
  Vector b(m + p), magnitude(m + p);
  const Vector left = y - Y.c;
  b << Y.b, left(present);
  const Matrix size = u.cwiseAbs();
  const Vector outputs = y.cwiseAbs() + tube.c_size + linalg::product(tube.H.cwiseAbs(), size);
  magnitude << tube.b_size + linalg::product(tube.Omega.cwiseAbs(), size), outputs(present);
  if (!magnitude.allFinite())
    throw Error(Errc::not_finite, "inputs and outputs overflow; scale the problem");
  const Index lines = S.cols(), factors = A.cols();
  const Vector terms = magnitude + A.cwiseAbs().rowwise().sum();
  const LineForm rows{Matrix(0, lines), Matrix(0, factors), Vector(0),
                      std::move(S),     std::move(A),       std::move(b)};
  const LinesEliminated rest = eliminate_lines_traced(rows, magnitude);
  Certificate proof;
  const Vector row_terms =
      linalg::product(rest.rows.cwiseAbs(), terms + TermsOfLines(rows.S, rest, 0).terms);
  Answer empty = BoxedProgram(rest.set.A, rest.set.b, {row_terms, tube_row_noise * row_terms})
                     .is_empty(&proof);
  if (empty == Answer::no && rest.vanished > 0)
    empty = Answer::unknown;  // what vanished is not shown to hold
  Certificate whole = empty == Answer::unknown ? Certificate{} : traced(rest, proof);
  const LinesReached reached{
      rest.lines_offset.cwiseAbs() + rest.lines_by_factors.cwiseAbs().rowwise().sum(),
      rest.free_lines};
  if (empty == Answer::yes && !proves_empty_through_lines(rows, terms, whole.data, reached)) {
    empty = Answer::unknown;  // what the elimination has lost is as large as the proof
    whole = {};
  }
  if (whole.kind == Certificate::Kind::farkas)
    whole.data = with_rows_of_missing(whole.data, m, present, y.size());
  if (why) *why = std::move(whole);
  return negate(empty);
}

}  // namespace cordon::diagnosers
