// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/line_elimination.hpp"

#include <cmath>
#include <vector>

#include "cordon/core/column_elimination.hpp"
#include "cordon/core/exact_rank.hpp"
#include "cordon/core/tolerances.hpp"

namespace cordon {

namespace {

constexpr double vague = 1e-6;  ///< to this one, it is no pivot

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Rows of [S A b] above rows of [M G c], with the magnitude of the terms that each entry was
/// computed from, and the combination of the original rows [S A b] that was added to each, if it is
/// asked for (not kept up for rows that are used up). Rows of banded systems touch few others and
/// in few places: only those are visited. Observers eliminate in every step: each thread keeps one,
/// with its memory; unlike a plugin, the framework's library is never unloaded.
struct Tableau {
  /// The largest equilibrated entry of a row of S.
  struct Candidate {
    double size = 0;  ///< 0: there is none
    Index col = 0;
  };
  /// Columns in a row, from `first` to before `last`.
  struct Run {
    Index first, last;
  };

  Index lines = 0, rows = 0, width = 0;
  RowMajor T, magnitude, trace;
  std::vector<bool> used;
  std::vector<Candidate> candidates;  ///< of every row
  Eigen::RowVectorXd pivot, pivot_magnitude, pivot_trace;
  std::vector<Run> runs, trace_runs;  ///< of the pivot row

  /// `b_magnitude`: size of what cancelled in b already; may be empty.
  void take(const LineForm& X, VectorIn b_magnitude, bool traced) {
    lines = X.lines();
    rows = X.constraints();
    width = lines + X.generators() + 1;
    T.resize(rows + X.dim(), width);
    trace.setIdentity(rows + X.dim(), traced ? rows : 0);
    used.assign(static_cast<std::size_t>(rows), false);
    candidates.clear();
    const Index g = X.generators();
    T.topLeftCorner(rows, lines) = X.S;
    T.block(0, lines, rows, g) = X.A;
    T.topRightCorner(rows, 1) = X.b;
    T.bottomLeftCorner(X.dim(), lines) = X.M;
    T.block(rows, lines, X.dim(), g) = X.G;
    T.bottomRightCorner(X.dim(), 1) =
        -X.c;  // so that every row is treated alike: x = Mδ + Gξ - (-c)
    magnitude = T.cwiseAbs();
    if (b_magnitude.size() > 0)
      magnitude.col(width - 1).head(rows) =
          magnitude.col(width - 1).head(rows).cwiseMax(b_magnitude);
    candidates.reserve(static_cast<std::size_t>(rows));
    for (Index i = 0; i < rows; ++i) candidates.push_back(candidate(i));
  }

  /// An entry that has cancelled to little is known with few digits: what is divided by it would be
  /// as vague.
  Candidate candidate(Index i) const {
    Candidate best;
    if (lines == 0) return best;
    const double scale = T.row(i).head(width - 1).cwiseAbs().maxCoeff();
    for (Index j = 0; j < lines; ++j) {
      if (!(std::abs(T(i, j)) > vague * magnitude(i, j))) continue;
      if (std::abs(T(i, j)) / scale > best.size) best = {std::abs(T(i, j)) / scale, j};
    }
    return best;
  }

  /// Rows that hold lines still say nothing that can be used without them.
  bool holds_lines(Index row) const { return !T.row(row).head(lines).isZero(0); }

  /// The largest equilibrated entry of S among unused rows; false if none is left.
  bool find_pivot(Index& row, Index& col) const {
    double best = 0;
    for (Index i = 0; i < rows; ++i) {
      const Candidate& here = candidates[static_cast<std::size_t>(i)];
      if (used[static_cast<std::size_t>(i)] || !(here.size > best)) continue;
      best = here.size;
      row = i;
      col = here.col;
    }
    return best > 0;
  }

  static void find_runs(const Eigen::RowVectorXd& row, std::vector<Run>& runs) {
    runs.clear();
    for (Index j = 0; j < row.size(); ++j) {
      if (row[j] == 0) continue;
      if (runs.empty() || runs.back().last != j) runs.push_back({j, j});
      runs.back().last = j + 1;
    }
  }

  /// Terms inherit the magnitude of the pivot row: what cancelled there is
  /// noise here too. Of b and c nothing is left out: where states are large
  /// and their sets small, 1e-13 of them is more than the set.
  void eliminate(Index row, Index col) {
    used[static_cast<std::size_t>(row)] = true;
    const double divisor = T(row, col);
    pivot = T.row(row) / divisor;
    pivot_magnitude = magnitude.row(row) / std::abs(divisor);
    pivot_trace = trace.row(row) / divisor;
    find_runs(pivot_magnitude, runs);
    find_runs(pivot_trace, trace_runs);
    for (Index i = 0; i < T.rows(); ++i) {
      const double factor = T(i, col);
      if (i == row || factor == 0) continue;
      const double right = T(i, width - 1) - factor * pivot[width - 1];
      for (const Run& run : runs) {
        subtract(factor, pivot.data(), pivot_magnitude.data(), run, T.row(i).data(),
                 magnitude.row(i).data());
      }
      T(i, width - 1) = right;
      T(i, col) = 0;
      if (i < rows && used[static_cast<std::size_t>(i)]) continue;
      for (const auto& [first, last] : trace_runs) {
        trace.row(i).segment(first, last - first) -=
            factor * pivot_trace.segment(first, last - first);
      }
      if (i < rows) candidates[static_cast<std::size_t>(i)] = candidate(i);
    }
    T.row(row) =
        pivot;  // kept, and treated like the others from now on: it tells the line by the factors
    magnitude.row(row) = pivot_magnitude;
    T(row, col) = 1;
  }

  static void subtract(double factor, const double* pivot, const double* pivot_magnitude, Run run,
                       double* entries, double* sizes) {
    const double size = std::abs(factor);
    for (Index j = run.first; j < run.last; ++j) {
      const double entry = entries[j] - factor * pivot[j];
      const double terms = std::max(sizes[j], size * pivot_magnitude[j]);
      sizes[j] = terms;
      entries[j] = std::abs(entry) <= tolerances::elimination_noise * terms ? 0 : entry;
    }
  }

  /// 0 = 0 up to rounding: every coefficient and the right-hand side cancelled. Dropping a row
  /// never shrinks the set.
  bool vanished(Index row) const {
    return (T.row(row).tail(width - lines).array().abs() <=
            tolerances::elimination_noise * magnitude.row(row).tail(width - lines).array())
        .all();
  }
};

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

/// The columns of M that are left, and the sizes of their terms.
struct LinesLeft {
  Matrix M, terms;
};
LinesLeft lines_left(const Tableau& tableau, const LineForm& X, const Pivots& pivots) {
  const Index n = X.dim();
  std::vector<bool> gone(static_cast<std::size_t>(X.lines()), false);
  for (const auto& [row, col] : pivots) gone[static_cast<std::size_t>(col)] = true;
  std::vector<Index> kept;
  for (Index j = 0; j < X.lines(); ++j) {
    if (!gone[static_cast<std::size_t>(j)]) kept.push_back(j);
  }
  return {tableau.T.bottomRows(n)(Eigen::all, kept),
          tableau.magnitude.bottomRows(n)(Eigen::all, kept)};
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

/// What is left of X but for its lines; row k of the set is row kept[k] of the tableau.
LineForm remainder(const Tableau& tableau, const LineForm& X, std::vector<Index>& kept) {
  const Index n = X.dim(), g = X.generators();
  for (Index i = 0; i < tableau.rows; ++i) {
    if (!tableau.used[static_cast<std::size_t>(i)] && !tableau.vanished(i) &&
        !tableau.holds_lines(i))
      kept.push_back(i);
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

/// Whether S has more independent rows than pivots were found: what cancelled to
/// noise was there, and held lines.
bool rank_was_lost(const LineForm& X, const Pivots& pivots) {
  const auto found = static_cast<Index>(pivots.size());
  if (found == X.lines() || found == (X.S.array() != 0).rowwise().any().count()) return false;
  return rank_modulo_prime(X.S) > found;
}

LinesSolved solved(const LineForm& X, bool hold_hidden) {
  if (X.lines() == 0) return {X, Vector::Zero(X.constraints()), Vector::Zero(X.dim())};
  Tableau& tableau = tableau_of(X, Vector(0), false);
  const Pivots pivots = eliminate(tableau);
  std::vector<Index> kept;
  LineForm set = remainder(tableau, X, kept);
  LinesLeft lines = lines_left(tableau, X, pivots);
  bool is_whole = !rank_was_lost(X, pivots);
  if (hold_hidden) is_whole = hold_hidden_lines(lines, X, pivots) && is_whole;
  set_lines(set, std::move(lines.M));
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
            Vector(0)};
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
  LineForm set = remainder(tableau, X, kept);
  set_lines(set, lines_left(tableau, X, pivots).M);
  Matrix rows(static_cast<Index>(kept.size()), all);
  for (Index k = 0; k < rows.rows(); ++k)
    rows.row(k) = tableau.trace.row(kept[static_cast<std::size_t>(k)]);
  const Index vanished = all - static_cast<Index>(pivots.size()) - set.constraints();
  return {std::move(set),
          largest(tableau, kept),
          std::move(rows),
          Matrix(tableau.trace.bottomRows(n)),
          std::move(lines_by_factors),
          std::move(lines_offset),
          vanished};
}

}  // namespace cordon
