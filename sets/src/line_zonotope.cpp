// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/line_zonotope.hpp"

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_elimination.hpp"
#include "false_row.hpp"

namespace cordon::sets {

namespace {

constexpr double product_noise = 1e-14;  ///< cancelled to this share of its terms, a value is zero

}  // namespace

LineZonotope affine_sum(const LineZonotope& X, MatrixIn A, VectorIn f, std::span<const Summand> summands) {
  LineZonotope Y = affine_map(X, A, f);
  if (summands.empty()) return Y;
  Index lines = X.lines(), generators = X.generators(), constraints = X.constraints();
  for (const Summand& s : summands) {
    lines += s.set.lines();
    generators += s.set.generators();
    constraints += s.set.constraints();
  }
  const Index m = A.rows();
  Index line = X.lines(), generator = X.generators(), row = X.constraints();
  Y.M.conservativeResize(m, lines);
  Y.G.conservativeResize(m, generators);
  Y.b.conservativeResize(constraints);
  Matrix S = Matrix::Zero(constraints, lines), B = Matrix::Zero(constraints, generators);
  S.topLeftCorner(row, line) = X.S;
  B.topLeftCorner(row, generator) = X.A;
  for (const Summand& s : summands) {
    const LineZonotope mapped = affine_map(s.set, s.T, Vector::Zero(m));
    Y.M.middleCols(line, mapped.lines()) = mapped.M;
    Y.G.middleCols(generator, mapped.generators()) = mapped.G;
    Y.c += mapped.c;
    S.block(row, line, mapped.constraints(), mapped.lines()) = mapped.S;
    B.block(row, generator, mapped.constraints(), mapped.generators()) = mapped.A;
    Y.b.segment(row, mapped.constraints()) = mapped.b;
    line += mapped.lines();
    generator += mapped.generators();
    row += mapped.constraints();
  }
  Y.S = std::move(S);
  Y.A = std::move(B);
  return Y;
}

LineZonotope strip_intersection(const LineZonotope& X, MatrixIn C, VectorIn z, MatrixIn T, const LineZonotope& V) {
  LineZonotope Y = intersection(X, C, affine_map(V, -T, z));
  // z - T c_V - C c_X cancels where the sets touch: a residue is no statement
  const Vector terms =
      z.cwiseAbs() + linalg::product(T.cwiseAbs(), V.c.cwiseAbs()) + linalg::product(C.cwiseAbs(), X.c.cwiseAbs());
  auto right = Y.b.tail(z.size());
  right = (right.array().abs() <= product_noise * terms.array()).select(0.0, right).eval();
  return Y;
}

namespace {

/// Zero columns carry nothing, except in a set proven wrong by its rows alone, which keeps its rows.
LineZonotope drop_zero_generators(LineZonotope X) {
  Index kept = 0;
  for (Index j = 0; j < X.generators(); ++j) {
    if (X.G.col(j).isZero(0) && X.A.col(j).isZero(0)) continue;
    if (kept != j) {
      X.G.col(kept) = X.G.col(j);
      X.A.col(kept) = X.A.col(j);
    }
    ++kept;
  }
  X.G.conservativeResize(Eigen::NoChange, kept);
  X.A.conservativeResize(Eigen::NoChange, kept);
  return X;
}

}  // namespace

Reduced reduce(const LineZonotope& X, Index max_generators, Index max_constraints, const LineReduction& how) {
  const Index n = X.dim();
  if (max_generators < n) {
    throw Error(Errc::invalid, "reduce: " + std::to_string(max_generators) + " generators cannot enclose a set of dimension " +
                                   std::to_string(n) + "; give at least " + std::to_string(n));
  }
  Reduced reduced = eliminate_constraints(eliminate_lines(X), max_constraints, how.constraints);
  reduced.set = drop_zero_generators(std::move(reduced.set));
  if (has_false_row(reduced.set)) return {make_empty(n), true};
  if (reduced.set.generators() <= max_generators) return reduced;
  if (n + reduced.set.constraints() > max_generators) {
    Reduced fewer = eliminate_constraints(reduced.set, max_generators - n, how.constraints);
    reduced = {drop_zero_generators(std::move(fewer.set)), reduced.exact && fewer.exact};
    if (has_false_row(reduced.set)) return {make_empty(n), true};
    if (reduced.set.generators() <= max_generators) return reduced;
  }
  LineZonotope& Y = reduced.set;
  Matrix lifted(n + Y.constraints(), Y.generators());
  lifted.topRows(n) = Y.G;
  lifted.bottomRows(Y.constraints()) = Y.A;
  lifted = reduce_generators(lifted, max_generators, how.generators);
  Y.G = lifted.topRows(n);
  Y.A = lifted.bottomRows(Y.constraints());
  reduced.exact = false;
  return reduced;
}

}  // namespace cordon::sets
