// SPDX-License-Identifier: GPL-3.0-or-later
// The work of line_elimination.hpp: rows, the sizes of what they were made of, and pivots.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "cordon/core/line_form.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/core/tolerances.hpp"

namespace cordon::detail {

/// Rows of [S A b] above rows of [M G c], with the magnitude of the terms that each entry was
/// computed from, and the combination of the original rows [S A b] that was added to each, if it is
/// asked for (not kept up for rows that are used up). Rows of banded systems touch few others and
/// in few places: only those are visited. Observers eliminate in every step: each thread keeps one,
/// with its memory; unlike a plugin, the framework's library is never unloaded.
struct LineTableau {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  static constexpr double vague = 1e-6;  ///< an entry that cancelled to this share of its terms is
                                         ///< known with few digits

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
  std::vector<bool> cut;              ///< an entry of a line was taken for noise, and left out
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
    cut.assign(static_cast<std::size_t>(rows + X.dim()), false);
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
  bool holds_lines(Index row) const {
    for (Index j = 0; j < lines; ++j) {
      if (!is_noise(row, j)) return true;
    }
    return false;
  }
  /// Is an entry of a line 0 up to the rounding of its terms, and that of all that they were
  /// computed from?
  bool is_noise(Index row, Index line) const {
    return std::abs(T(row, line)) <= tolerances::elimination_noise * magnitude(row, line);
  }
  /// Are there entries of lines that are taken for noise?
  bool is_cut(Index row) const {
    return cut[static_cast<std::size_t>(row)] || !T.row(row).head(lines).isZero(0);
  }

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

  /// Terms inherit the magnitude of the pivot row, and of what it is multiplied by: what cancelled
  /// there is noise here too. These magnitudes bound the rounding of an entry; along a chain of
  /// pivots they grow by a factor each, and real entries come to lie below their share. An entry of
  /// a line therefore is no pivot where it is vague, but stays, and takes part when another row is
  /// solved for its line: what is left of lines in the end is looked at again. A coefficient of a
  /// factor is left out only if it is noise of its own two terms, and of b and c nothing is: where
  /// states are large and their sets small, 1e-13 of them is more than the set.
  void eliminate(Index row, Index col) {
    used[static_cast<std::size_t>(row)] = true;
    const double divisor = T(row, col);
    pivot = T.row(row) / divisor;
    pivot_magnitude =
        magnitude.row(row).cwiseMax(pivot.cwiseAbs() * magnitude(row, col)) / std::abs(divisor);
    pivot_trace = trace.row(row) / divisor;
    find_runs(pivot_magnitude, runs);
    find_runs(pivot_trace, trace_runs);
    for (Index i = 0; i < T.rows(); ++i) {
      const double factor = T(i, col);
      if (i == row || factor == 0) continue;
      const double right = T(i, width - 1) - factor * pivot[width - 1];
      for (const Run& run : runs) subtract(factor, magnitude(i, col), run, i);
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

  /// `factor_magnitude`: of the terms that the factor itself was computed from.
  void subtract(double factor, double factor_magnitude, Run run, Index row) {
    double *const entries = T.row(row).data(), *const sizes = magnitude.row(row).data();
    const double size = std::abs(factor);
    const auto passed_on = [&](Index j) {
      return std::max(size * pivot_magnitude[j], factor_magnitude * std::abs(pivot[j]));
    };
    const Index end_of_lines = std::min(run.last, lines);
    bool cuts = false;
    for (Index j = run.first; j < end_of_lines; ++j) {
      const double left = entries[j], right = factor * pivot[j], entry = left - right;
      const bool is_rounding =
          std::abs(entry) <= 8 * rounding::unit * std::max(std::abs(left), std::abs(right));
      sizes[j] = std::max(sizes[j], passed_on(j));
      cuts = cuts || (is_rounding && left != 0);  // also where rounding happens to leave 0
      entries[j] = is_rounding ? 0 : entry;
    }
    for (Index j = std::max(run.first, lines); j < run.last; ++j) {
      const double right = factor * pivot[j], entry = entries[j] - right;
      sizes[j] = std::max(sizes[j], passed_on(j));
      entries[j] = std::abs(entry) <= tolerances::elimination_noise * std::abs(right) ? 0 : entry;
    }
    if (cuts) cut[static_cast<std::size_t>(row)] = true;
  }

  /// The factors' coefficients have cancelled so far that they are known with few digits, and have
  /// not vanished. Dropping the row makes the set larger.
  bool is_vague(Index row) const {
    const Index factors = width - 1 - lines;
    if (factors == 0) return false;
    const double share = vague * magnitude.row(row).segment(lines, factors).maxCoeff();
    bool is_zero = true;
    for (Index j = lines; j < width - 1; ++j) {
      if (std::abs(T(row, j)) > share) return false;
      is_zero = is_zero && T(row, j) == 0;
    }
    return !is_zero;
  }

  /// 0 = 0 up to rounding: every coefficient and the right-hand side cancelled. Dropping a row
  /// never shrinks the set.
  bool vanished(Index row) const {
    for (Index j = lines; j < width; ++j) {
      if (!(std::abs(T(row, j)) <= tolerances::elimination_noise * magnitude(row, j))) return false;
    }
    return true;
  }
};

}  // namespace cordon::detail
