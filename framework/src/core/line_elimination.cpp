// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/line_elimination.hpp"

#include <cmath>
#include <vector>

#include "cordon/core/linalg.hpp"

namespace cordon {

namespace {

constexpr double line_noise = 1e-10;   ///< cancelled to this share of its terms, a coefficient of a line, or a whole row, is zero
constexpr double other_noise = 1e-14;  ///< the same for a single coefficient of a generator or a right-hand side
constexpr double basis_noise = 1e-14;  ///< entries of an orthonormal basis below this are zero

/// Rows of [S A b] above rows of [M G c], with the magnitude of the terms that each entry was computed from.
struct Tableau {
  Index lines, rows, width;
  Matrix T, magnitude;
  std::vector<bool> used;

  explicit Tableau(const LineForm& X)
      : lines(X.lines()), rows(X.constraints()), width(lines + X.generators() + 1), T(rows + X.dim(), width), used(rows, false) {
    const Index g = X.generators();
    T.topLeftCorner(rows, lines) = X.S;
    T.block(0, lines, rows, g) = X.A;
    T.topRightCorner(rows, 1) = X.b;
    T.bottomLeftCorner(X.dim(), lines) = X.M;
    T.block(rows, lines, X.dim(), g) = X.G;
    T.bottomRightCorner(X.dim(), 1) = -X.c;  // so that every row is treated alike: x = Mδ + Gξ - (-c)
    magnitude = T.cwiseAbs();
  }

  /// The largest equilibrated entry of S among unused rows; false if none is left.
  bool find_pivot(Index& row, Index& col) const {
    double best = 0;
    for (Index i = 0; i < rows; ++i) {
      if (used[static_cast<std::size_t>(i)]) continue;
      const double scale = T.row(i).head(width - 1).cwiseAbs().maxCoeff();
      for (Index j = 0; j < lines; ++j) {
        if (T(i, j) != 0 && std::abs(T(i, j)) / scale > best) {
          best = std::abs(T(i, j)) / scale;
          row = i;
          col = j;
        }
      }
    }
    return best > 0;
  }

  void eliminate(Index row, Index col) {
    used[static_cast<std::size_t>(row)] = true;
    const Eigen::RowVectorXd pivot = T.row(row) / T(row, col);
    for (Index i = 0; i < T.rows(); ++i) {
      const double factor = T(i, col);
      if (i == row || factor == 0) continue;
      for (Index j = 0; j < width; ++j) {
        if (pivot[j] == 0) continue;
        const double term = factor * pivot[j];
        T(i, j) -= term;
        magnitude(i, j) = std::max(magnitude(i, j), std::abs(term));
        if (std::abs(T(i, j)) <= (j < lines ? line_noise : other_noise) * magnitude(i, j)) T(i, j) = 0;
      }
      T(i, col) = 0;
    }
    T.row(row).head(lines).setZero();
    T(row, col) = 1;
  }

  /// 0 = 0 up to rounding: every coefficient and the right-hand side cancelled. Dropping a row never shrinks the set.
  bool vanished(Index row) const {
    return (T.row(row).tail(width - lines).array().abs() <= line_noise * magnitude.row(row).tail(width - lines).array()).all();
  }
};

}  // namespace

LineForm eliminate_lines(const LineForm& X) {
  if (X.lines() == 0) return {Matrix(X.dim(), 0), X.G, X.c, Matrix(X.constraints(), 0), X.A, X.b};
  Tableau tableau(X);
  std::vector<bool> gone(static_cast<std::size_t>(X.lines()), false);
  for (Index row = 0, col = 0; tableau.find_pivot(row, col);) {
    tableau.eliminate(row, col);
    gone[static_cast<std::size_t>(col)] = true;
  }

  std::vector<Index> kept_rows, kept_lines;
  for (Index i = 0; i < tableau.rows; ++i) {
    if (!tableau.used[static_cast<std::size_t>(i)] && !tableau.vanished(i)) kept_rows.push_back(i);
  }
  for (Index j = 0; j < X.lines(); ++j) {
    if (!gone[static_cast<std::size_t>(j)]) kept_lines.push_back(j);
  }
  const Index n = X.dim(), g = X.generators(), m = static_cast<Index>(kept_rows.size());
  LineForm Y{Matrix(n, static_cast<Index>(kept_lines.size())),
             tableau.T.block(tableau.rows, X.lines(), n, g),
             -tableau.T.bottomRightCorner(n, 1),
             Matrix(),
             Matrix(m, g),
             Vector(m)};
  for (Index k = 0; k < Y.M.cols(); ++k) Y.M.col(k) = tableau.T.col(kept_lines[static_cast<std::size_t>(k)]).tail(n);
  for (Index k = 0; k < m; ++k) {
    Y.A.row(k) = tableau.T.row(kept_rows[static_cast<std::size_t>(k)]).segment(X.lines(), g);
    Y.b[k] = tableau.T(kept_rows[static_cast<std::size_t>(k)], tableau.width - 1);
  }
  if (Y.M.cols() > 0) {
    Y.M = linalg::range_basis(Y.M);
    Y.M = (Y.M.array().abs() < basis_noise).select(0.0, Y.M);
  }
  Y.S = Matrix::Zero(m, Y.M.cols());
  return Y;
}

}  // namespace cordon
