// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/line_zonotope.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_elimination.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/core/vectors.hpp"
#include "elimination_plan.hpp"
#include "false_row.hpp"
#include "line_image.hpp"
#include "require.hpp"
#include "residue.hpp"

namespace cordon::sets {

namespace {

void require_no_overflow(const LineZonotope& X) {
  for (const Matrix* block : {&X.M, &X.G, &X.S, &X.A}) {
    if (!vectors::all_finite(*block))
      throw Error(Errc::not_finite, "a set operation overflows; scale the problem");
  }
  if (!vectors::all_finite(X.c) || !vectors::all_finite(X.b))
    throw Error(Errc::not_finite, "a set operation overflows; scale the problem");
}

/// A line zonotope of this size; rows and columns of S and A are 0.
LineZonotope blank(Index dim, Index lines, Index generators, Index constraints) {
  return {Matrix(dim, lines),
          Matrix(dim, generators),
          Vector(dim),
          Matrix::Zero(constraints, lines),
          Matrix::Zero(constraints, generators),
          Vector(constraints)};
}

/// Without the rows that are not `kept`.
void keep_rows(LineZonotope& X, Terms& terms, const std::vector<Index>& kept) {
  if (static_cast<Index>(kept.size()) == X.constraints()) return;
  X.S = Matrix(X.S(kept, Eigen::all));
  X.A = Matrix(X.A(kept, Eigen::all));
  X.b = Vector(X.b(kept));
  terms.rows = Vector(terms.rows(kept));
}

/// What a row of this reach says: nothing that could be told from rounding, or that no point fits,
/// by less than proofs need. Without the latter the set is larger, perhaps by much.
enum class RowContent { statement, rounding, unproven_miss };

RowContent content_of_row(double terms, double reach, double b) {
  if (reach + std::abs(b) <= tolerances::product_noise * terms) return RowContent::rounding;
  const bool misses = std::abs(b) > reach && std::abs(b) <= tolerances::proof_margin * terms;
  return misses ? RowContent::unproven_miss : RowContent::statement;
}

}  // namespace

Reduced affine_sum(const LineZonotope& X, MatrixIn A, VectorIn f,
                   std::span<const Summand> summands) {
  constexpr const char* name = "sum of mapped sets";
  const Index m = A.rows();
  require_size(f.size(), m, name, "the translation");
  require_map(A, X.dim(), name, "the map");
  std::vector<LineImage> images{line_image(A, X)};
  Index lines = images.front().M.cols(), generators = X.generators(), constraints = X.constraints();
  for (const Summand& s : summands) {
    require_size(s.T.rows(), m, name, "the number of rows of a summand's map");
    require_map(s.T, s.set.dim(), name, "the map");
    images.push_back(line_image(s.T, s.set));
    lines += images.back().M.cols();
    generators += s.set.generators();
    constraints += s.set.constraints();
  }
  LineZonotope Y = blank(m, lines, generators, constraints);
  Y.c = f;
  Terms terms{Vector::Zero(constraints), f.cwiseAbs()};
  Vector size;  // of a summand's coordinates
  Index line = 0, generator = 0, row = 0;
  bool exact = true;
  const auto add = [&](MatrixIn T, const LineZonotope& Z, const LineImage& image) {
    const Index l = image.M.cols(), g = Z.generators(), rows = Z.constraints();
    if (l > 0) Y.M.middleCols(line, l) = image.M;
    exact = exact && image.exact;
    linalg::product(T, Z.G, Y.G.middleCols(generator, g));
    take_reach(Z.c, Z.G, size);
    for (Index k = 0; k < T.cols(); ++k) {
      Y.c += T.col(k) * Z.c[k];
      terms.state += T.col(k).cwiseAbs() * size[k];
    }
    if (rows > 0) {
      if (l >= Z.lines()) Y.S.block(row, line, rows, Z.lines()) = Z.S;
      Y.A.block(row, generator, rows, g) = Z.A;
      Y.b.segment(row, rows) = Z.b;
    }
    line += l;
    generator += g;
    row += rows;
  };
  add(A, X, images.front());
  for (std::size_t i = 0; i < summands.size(); ++i)
    add(summands[i].T, summands[i].set, images[i + 1]);
  require_no_overflow(Y);
  if (summands.empty()) return {std::move(Y), exact};
  return {with_residue(std::move(Y), terms), exact};
}

Reduced strip_intersection(const LineZonotope& X, MatrixIn C, VectorIn z, MatrixIn T,
                           const LineZonotope& V) {
  constexpr const char* name = "intersection with a measurement";
  const Index p = C.rows(), lines = X.lines(), g = X.generators(),
              old = X.constraints() + V.constraints();
  require_map(C, X.dim(), name, "C");
  require_map(T, V.dim(), name, "T");
  require_size(T.rows(), p, name, "the number of rows of T");
  require_size(z.size(), p, name, "z");
  // C x = z - T v, with the factors of V behind those of X
  LineZonotope Y = blank(X.dim(), lines + V.lines(), g + V.generators(), old + p);
  Y.M.leftCols(lines) = X.M;
  Y.M.rightCols(V.lines()).setZero();
  Y.G.leftCols(g) = X.G;
  Y.G.rightCols(V.generators()).setZero();
  Y.c = X.c;
  Y.S.topLeftCorner(X.constraints(), lines) = X.S;
  Y.S.block(X.constraints(), lines, V.constraints(), V.lines()) = V.S;
  if (lines > 0) Y.S.bottomLeftCorner(p, lines) = linalg::denoised_product(C, X.M);
  if (V.lines() > 0) Y.S.bottomRightCorner(p, V.lines()) = linalg::denoised_product(T, V.M);
  Y.A.topLeftCorner(X.constraints(), g) = X.A;
  Y.A.block(X.constraints(), g, V.constraints(), V.generators()) = V.A;
  linalg::product(C, X.G, Y.A.bottomLeftCorner(p, g));
  linalg::product(T, V.G, Y.A.bottomRightCorner(p, V.generators()));
  Y.b.head(X.constraints()) = X.b;
  Y.b.segment(X.constraints(), V.constraints()) = V.b;

  Terms terms = no_terms(Y);
  Vector of_X, of_V;
  take_reach(X.c, X.G, of_X);
  take_reach(V.c, V.G, of_V);
  std::vector<Index> kept(static_cast<std::size_t>(old));
  std::iota(kept.begin(), kept.end(), Index{0});
  kept.reserve(static_cast<std::size_t>(old + p));
  bool exact = true;
  for (Index k = 0; k < p; ++k) {
    double right = z[k], center_terms = std::abs(z[k]), all_terms = std::abs(z[k]);
    const auto subtract = [&](MatrixIn map, const Vector& center, const Vector& reach) {
      for (Index j = 0; j < map.cols(); ++j) {
        right -= map(k, j) * center[j];
        center_terms += std::abs(map(k, j) * center[j]);
        all_terms += std::abs(map(k, j)) * reach[j];
      }
    };
    subtract(T, V.c, of_V);
    subtract(C, X.c, of_X);
    // z - T c_V - C c_X cancels where the sets touch: a residue is no statement
    Y.b[old + k] = std::abs(right) <= tolerances::product_noise * center_terms ? 0 : right;
    terms.rows[old + k] = all_terms;
    const bool has_lines = Y.lines() > 0 && !Y.S.row(old + k).isZero(0);
    const RowContent content =
        has_lines ? RowContent::statement
                  : content_of_row(all_terms, Y.A.row(old + k).lpNorm<1>(), Y.b[old + k]);
    if (content == RowContent::statement) kept.push_back(old + k);
    exact = exact && content != RowContent::unproven_miss;
  }
  require_no_overflow(Y);
  keep_rows(Y, terms, kept);
  return {with_residue(std::move(Y), terms), exact};
}

namespace {

constexpr double exact_room = 1e-9;  ///< of its size: a coordinate widened by less counts as exact

struct Computed {
  LineZonotope set;
  Terms terms;
  bool is_whole;  ///< nothing was forgotten
};

/// Lines eliminated; what cancelled there counts as in a measurement.
Computed without_lines(const LineZonotope& X) {
  LinesSolved made = solve_for_lines(X);
  std::vector<Index> kept;
  for (Index i = 0; i < made.set.constraints(); ++i) {
    const RowContent content =
        content_of_row(made.row_magnitude[i], made.set.A.row(i).lpNorm<1>(), made.set.b[i]);
    if (content == RowContent::statement) kept.push_back(i);
    made.is_whole = made.is_whole && content != RowContent::unproven_miss;
  }
  Terms terms{std::move(made.row_magnitude), std::move(made.state_magnitude)};
  keep_rows(made.set, terms, kept);
  return {std::move(made.set), std::move(terms), made.is_whole};
}

/// Is what rounding adds to every coordinate next to nothing beside its size?
bool widens_little(const LineZonotope& X, const Terms& terms) {
  Vector reach;
  take_reach(X.c, X.G, reach);
  return (tolerances::product_noise * terms.state.array() <= exact_room * reach.array()).all();
}

/// Zero columns carry nothing, except in a set proven wrong by its rows alone, which keeps its
/// rows.
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
  if (kept == X.generators()) return X;
  X.G.conservativeResize(Eigen::NoChange, kept);
  X.A.conservativeResize(Eigen::NoChange, kept);
  return X;
}

}  // namespace

Reduced reduce(const LineZonotope& X, Index max_generators, Index max_constraints,
               const LineReduction& how) {
  const Index n = X.dim();
  if (max_generators < n) {
    throw Error(Errc::invalid, "reduce: " + std::to_string(max_generators) +
                                   " generators cannot enclose a set of dimension " +
                                   std::to_string(n) + "; give at least " + std::to_string(n));
  }
  Reduced reduced;
  if (X.lines() > 0) {
    const auto [set, terms, is_whole] = without_lines(X);
    reduced = eliminate_constraints(set, terms, max_constraints, how.constraints);
    reduced.exact = reduced.exact && is_whole && widens_little(set, terms);
  } else if (X.constraints() == 0) {
    reduced = {X, true};
  } else {
    reduced = eliminate_constraints(X, max_constraints, how.constraints);
  }
  reduced.set = drop_zero_generators(std::move(reduced.set));
  if (has_false_row(reduced.set)) return {make_empty(n), true};
  if (reduced.set.generators() <= max_generators) return reduced;
  if (reduced.set.constraints() > most_constraints(n, max_generators)) {
    Reduced fewer =
        eliminate_constraints(reduced.set, most_constraints(n, max_generators), how.constraints);
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
