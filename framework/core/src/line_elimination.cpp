// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/line_elimination.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cordon/core/column_elimination.hpp"
#include "cordon/core/exact_rank.hpp"
#include "cordon/core/tolerances.hpp"
#include "line_tableau.hpp"

namespace cordon {

namespace {

using Tableau = detail::LineTableau;

/// The columns of M that span the same space, none of them superfluous: column elimination with the
/// same rule for noise. Lines are unbounded, so a column may be scaled, and
/// small entries of a column are directions like any other.
Matrix independent_columns(Matrix M) {
  const Index n = M.rows();
  Matrix magnitude = M.cwiseAbs();
  std::vector<bool> row_used(static_cast<std::size_t>(n), false);
  Index kept = 0;
  while (kept < M.cols()) {
    Index row = -1, col = -1;
    double best = 0;
    for (Index i = 0; i < n; ++i) {
      if (row_used[static_cast<std::size_t>(i)]) continue;
      const double scale = magnitude.row(i).tail(M.cols() - kept).maxCoeff();
      for (Index j = kept; j < M.cols(); ++j) {
        if (M(i, j) != 0 && std::abs(M(i, j)) / scale > best) {
          best = std::abs(M(i, j)) / scale;
          row = i;
          col = j;
        }
      }
    }
    if (row < 0) break;
    row_used[static_cast<std::size_t>(row)] = true;
    M.col(kept).swap(M.col(col));
    magnitude.col(kept).swap(magnitude.col(col));
    for (Index j = kept + 1; j < M.cols(); ++j) {
      const double factor = M(row, j) / M(row, kept);
      if (factor == 0) continue;
      for (Index i = 0; i < n; ++i) {
        M(i, j) -= factor * M(i, kept);
        magnitude(i, j) = std::max(magnitude(i, j), std::abs(factor) * magnitude(i, kept));
        if (std::abs(M(i, j)) <= tolerances::elimination_noise * magnitude(i, j)) M(i, j) = 0;
      }
      M(row, j) = 0;
    }
    M.col(kept) *= std::ldexp(1.0, -std::ilogb(M.col(kept).cwiseAbs().maxCoeff()));
    ++kept;
  }
  return M.leftCols(kept);
}

Tableau& tableau_of(const LineForm& X, VectorIn b_magnitude, bool traced) {
  static thread_local Tableau tableau;
  tableau.take(X, b_magnitude, traced);
  return tableau;
}

using Pivots = std::vector<std::pair<Index, Index>>;

Pivots eliminate(Tableau& tableau) {
  Pivots pivots;
  for (Index row = 0, col = 0; tableau.find_pivot(row, col);) {
    tableau.eliminate(row, col);
    pivots.emplace_back(row, col);
  }
  return pivots;
}

/// Lines that no row was solved for.
std::vector<Index> free_lines(const LineForm& X, const Pivots& pivots) {
  std::vector<bool> gone(static_cast<std::size_t>(X.lines()), false);
  for (const auto& [row, col] : pivots) gone[static_cast<std::size_t>(col)] = true;
  std::vector<Index> free;
  for (Index j = 0; j < X.lines(); ++j) {
    if (!gone[static_cast<std::size_t>(j)]) free.push_back(j);
  }
  return free;
}

/// The columns of M that are left, and the sizes of their terms.
struct LinesLeft {
  Matrix M, terms;
};
LinesLeft lines_left(const Tableau& tableau, const LineForm& X, const Pivots& pivots) {
  const Index n = X.dim();
  const std::vector<Index> kept = free_lines(X, pivots);
  Matrix M = tableau.T.bottomRows(n)(Eigen::all, kept),
         terms = tableau.magnitude.bottomRows(n)(Eigen::all, kept);
  M = (M.array().abs() <= tolerances::elimination_noise * terms.array()).select(0.0, M);
  return {std::move(M), std::move(terms)};
}

/// Where rounding hides how many of the lines left are independent, adds the coordinates that they
/// may reach. Was nothing added?
bool hold_hidden_lines(LinesLeft& lines, const LineForm& X, const Pivots& pivots) {
  if (lines.M.cols() == 0) return true;
  const ColumnElimination known(lines.M, lines.terms);
  if (known.kept == lines.M.cols()) return true;
  Matrix all(X.constraints() + X.dim(), X.lines());
  all << X.S, X.M;
  if (rank_modulo_prime(all) <= known.kept + static_cast<Index>(pivots.size())) return true;
  lines.M = with_unit_vectors(std::move(lines.M), known.reached());
  return false;
}

/// Whether S has more independent rows than pivots were found: what cancelled to
/// noise was there, and held lines.
bool rank_was_lost(const LineForm& X, const Pivots& pivots) {
  const auto found = static_cast<Index>(pivots.size());
  if (found == X.lines() || found == (X.S.array() != 0).rowwise().any().count()) return false;
  return rank_modulo_prime(X.S) > found;
}

/// What is left of X but for its lines; row k of the set is row kept[k] of the tableau.
/// Where rank was lost, lines that were taken for noise may be those that are missing: such rows
/// say nothing.
struct Dropped {
  bool rank_lost;   ///< rows in which lines were taken for noise
  bool vague_rows;  ///< rows whose coefficients are known with few digits
};
LineForm remainder(const Tableau& tableau, const LineForm& X, std::vector<Index>& kept,
                   const Dropped& dropped) {
  const Index n = X.dim(), g = X.generators();
  for (Index i = 0; i < tableau.rows; ++i) {
    if (tableau.used[static_cast<std::size_t>(i)] || tableau.holds_lines(i)) continue;
    const bool is_free = !(dropped.rank_lost && tableau.is_cut(i)),
               is_vague = dropped.vague_rows && tableau.is_vague(i);
    if (is_free && !is_vague && !tableau.vanished(i)) kept.push_back(i);
  }
  const Index m = static_cast<Index>(kept.size());
  LineForm Y{Matrix(n, 0),
             tableau.T.block(tableau.rows, X.lines(), n, g),
             -tableau.T.bottomRightCorner(n, 1),
             Matrix(),
             Matrix(m, g),
             Vector(m)};
  for (Index k = 0; k < m; ++k) {
    const Index i = kept[static_cast<std::size_t>(k)];
    Y.A.row(k) = tableau.T.row(i).segment(X.lines(), g);
    Y.b[k] = tableau.T(i, tableau.width - 1);
  }
  return Y;
}

void set_lines(LineForm& Y, Matrix M) {
  Y.M = M.cols() > 0 ? independent_columns(std::move(M)) : std::move(M);
  Y.S = Matrix::Zero(Y.constraints(), Y.M.cols());
}

/// Largest terms of the factors and of the right-hand side. Those of lines do not count: a line may
/// have any length.
Vector largest(const Tableau& tableau, const std::vector<Index>& rows) {
  Vector sizes(static_cast<Index>(rows.size()));
  for (Index k = 0; k < sizes.size(); ++k)
    sizes[k] = tableau.magnitude.row(rows[static_cast<std::size_t>(k)])
                   .tail(tableau.width - tableau.lines)
                   .maxCoeff();
  return sizes;
}

/// Likewise of the state, added up.
Vector state_terms(const Tableau& tableau, Index n) {
  return tableau.magnitude.bottomRightCorner(n, tableau.width - tableau.lines).rowwise().sum();
}

/// Do the rows that are neither pivots nor kept follow from the pivots' rows, in exact arithmetic?
bool vanish_exactly(const LineForm& X, const Pivots& pivots, const std::vector<Index>& kept) {
  std::vector<Index> rows;
  for (const auto& [row, col] : pivots) rows.push_back(row);
  const Index found = static_cast<Index>(rows.size());
  for (Index i = 0; i < X.constraints(); ++i) {
    const bool is_there = std::find(kept.begin(), kept.end(), i) != kept.end() ||
                          std::find(rows.begin(), rows.begin() + found, i) != rows.begin() + found;
    if (!is_there) rows.push_back(i);
  }
  Matrix all(static_cast<Index>(rows.size()), X.lines() + X.generators() + 1);
  all << X.S(rows, Eigen::all), X.A(rows, Eigen::all), X.b(rows);
  return rank_modulo_prime(all) <= found;
}

LinesSolved solved(const LineForm& X, bool hold_hidden) {
  if (X.lines() == 0) return {X, Vector::Zero(X.constraints()), Vector::Zero(X.dim())};
  Tableau& tableau = tableau_of(X, Vector(0), false);
  const Pivots pivots = eliminate(tableau);
  std::vector<Index> kept;
  bool is_whole = !rank_was_lost(X, pivots);
  LineForm set = remainder(tableau, X, kept, {!is_whole, true});
  LinesLeft lines = lines_left(tableau, X, pivots);
  if (hold_hidden) is_whole = hold_hidden_lines(lines, X, pivots) && is_whole;
  set_lines(set, std::move(lines.M));
  const bool all_there = static_cast<Index>(pivots.size() + kept.size()) == X.constraints();
  is_whole = is_whole && (all_there || vanish_exactly(X, pivots, kept));
  for (Index i = 0; i < tableau.rows; ++i)
    is_whole = is_whole && (tableau.used[static_cast<std::size_t>(i)] || !tableau.holds_lines(i));
  return {std::move(set), largest(tableau, kept), state_terms(tableau, X.dim()), is_whole};
}

}  // namespace

LineForm eliminate_lines(const LineForm& X) { return solved(X, false).set; }

LinesSolved solve_for_lines(const LineForm& X) { return solved(X, true); }

LinesEliminated eliminate_lines_traced(const LineForm& X, VectorIn b_magnitude) {
  const Index n = X.dim(), g = X.generators(), all = X.constraints();
  if (X.lines() == 0) {
    return {{Matrix(n, 0), X.G, X.c, Matrix(all, 0), X.A, X.b},
            b_magnitude.size() ? Vector(b_magnitude) : Vector::Zero(all),
            Matrix::Identity(all, all),
            Matrix::Zero(n, all),
            Matrix(0, g),
            Vector(0),
            {}};
  }
  Tableau& tableau = tableau_of(X, b_magnitude, true);
  const Pivots pivots = eliminate(tableau);
  Matrix lines_by_factors = Matrix::Zero(X.lines(), g);
  Vector lines_offset = Vector::Zero(X.lines());
  for (const auto& [row, col] : pivots) {
    lines_by_factors.row(col) = -tableau.T.row(row).segment(X.lines(), g);
    lines_offset[col] = tableau.T(row, tableau.width - 1);
  }
  std::vector<Index> kept;
  bool any_cut = false;
  for (Index i = 0; i < all; ++i) {
    const bool is_left = !tableau.used[static_cast<std::size_t>(i)];
    any_cut = any_cut || (is_left && tableau.is_cut(i));
  }
  LineForm set = remainder(tableau, X, kept, {any_cut && rank_was_lost(X, pivots), false});
  set_lines(set, lines_left(tableau, X, pivots).M);
  Matrix rows(static_cast<Index>(kept.size()), all);
  for (Index k = 0; k < rows.rows(); ++k)
    rows.row(k) = tableau.trace.row(kept[static_cast<std::size_t>(k)]);
  const Index vanished = all - static_cast<Index>(pivots.size()) - set.constraints();
  const bool follow = vanished == 0 || vanish_exactly(X, pivots, kept);
  return {std::move(set),
          largest(tableau, kept),
          std::move(rows),
          Matrix(tableau.trace.bottomRows(n)),
          std::move(lines_by_factors),
          std::move(lines_offset),
          free_lines(X, pivots),
          vanished,
          follow};
}

}  // namespace cordon
