// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/line_zonotope.hpp"

#include <cmath>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_elimination.hpp"
#include "false_row.hpp"
#include "residue.hpp"

namespace cordon::sets {

namespace {

/// |T| (|c| + |G| 1), the size of the terms of T X.
Vector terms_of_map(MatrixIn T, const LineZonotope& X) {
  const Vector reach = X.c.cwiseAbs() + X.G.cwiseAbs().rowwise().sum();
  return linalg::product(T.cwiseAbs(), reach);
}

LineZonotope assembled_sum(const LineZonotope& X, MatrixIn A, VectorIn f, std::span<const Summand> summands) {
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

/// Without the rows that are not `kept`.
LineZonotope with_rows(LineZonotope X, const std::vector<Index>& kept) {
  if (static_cast<Index>(kept.size()) == X.constraints()) return X;
  X.S = Matrix(X.S(kept, Eigen::all));
  X.A = Matrix(X.A(kept, Eigen::all));
  X.b = Vector(X.b(kept));
  return X;
}

/// Does this row say nothing that could be told from rounding? One that misses the set by less than proofs need is such a row.
bool is_vague(double terms, double reach, double b) {
  return reach + std::abs(b) <= nominal_noise * terms || (std::abs(b) > reach && std::abs(b) <= nominal_margin * terms);
}

}  // namespace

LineZonotope affine_sum(const LineZonotope& X, MatrixIn A, VectorIn f, std::span<const Summand> summands) {
  const LineZonotope Y = assembled_sum(X, A, f, summands);
  if (summands.empty()) return Y;
  Vector terms = f.cwiseAbs() + terms_of_map(A, X);
  for (const Summand& s : summands) terms += terms_of_map(s.T, s.set);
  return with_residue(Y, Vector::Zero(Y.constraints()), terms);
}

LineZonotope strip_intersection(const LineZonotope& X, MatrixIn C, VectorIn z, MatrixIn T, const LineZonotope& V) {
  LineZonotope Y = intersection(X, C, affine_map(V, -T, z));
  const Vector center_terms =
      z.cwiseAbs() + linalg::product(T.cwiseAbs(), V.c.cwiseAbs()) + linalg::product(C.cwiseAbs(), X.c.cwiseAbs());
  const Vector terms = z.cwiseAbs() + terms_of_map(T, V) + terms_of_map(C, X);
  const Index first = Y.constraints() - z.size();
  Vector row_terms = Vector::Zero(Y.constraints());
  std::vector<Index> kept;
  for (Index i = 0; i < Y.constraints(); ++i) {
    const Index k = i - first;
    // z - T c_V - C c_X cancels where the sets touch: a residue is no statement
    if (k >= 0 && std::abs(Y.b[i]) <= nominal_noise * center_terms[k]) Y.b[i] = 0;
    if (k >= 0 && Y.S.row(i).isZero(0) && is_vague(terms[k], Y.A.row(i).lpNorm<1>(), Y.b[i])) continue;
    if (k >= 0) row_terms[i] = terms[k];
    kept.push_back(i);
  }
  return with_residue(with_rows(std::move(Y), kept), row_terms(kept), Vector::Zero(X.dim()));
}

namespace {

/// Lines eliminated; what cancelled there counts as in a measurement.
LineZonotope without_lines(const LineZonotope& X) {
  if (X.lines() == 0) return X;
  LinesEliminated made = eliminate_lines_traced(X, Vector(0));
  std::vector<Index> kept;
  for (Index i = 0; i < made.set.constraints(); ++i) {
    if (!is_vague(made.row_magnitude[i], made.set.A.row(i).lpNorm<1>(), made.set.b[i])) kept.push_back(i);
  }
  const Vector rows = X.b.cwiseAbs() + X.A.cwiseAbs().rowwise().sum();
  const Vector state_terms = X.c.cwiseAbs() + X.G.cwiseAbs().rowwise().sum() + linalg::product(made.outputs.cwiseAbs(), rows);
  return with_residue(with_rows(std::move(made.set), kept), made.row_magnitude(kept), state_terms);
}

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
  Reduced reduced = eliminate_constraints(without_lines(X), max_constraints, how.constraints);
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
