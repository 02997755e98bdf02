// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/line_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"

namespace cordon {

namespace {

/// The smallest power of two that is at least x > 0.
double power_of_two_above(double x) {
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);
  return std::ldexp(1.0, fraction == 0.5 ? exponent - 1 : exponent);
}

Matrix chosen(const Matrix& A, const std::vector<Index>& rows) {
  Matrix B(static_cast<Index>(rows.size()), A.cols());
  for (Index i = 0; i < B.rows(); ++i) B.row(i) = A.row(rows[as_size(i)]);
  return B;
}

/// Rows that determine all columns of S, by Gaussian elimination with pivots over the whole of it;
/// nothing for a smaller rank. The choice is a proposal: what follows from it is proven.
std::optional<std::vector<Index>> pivot_rows(Matrix S) {
  std::vector<Index> rows;
  std::vector<bool> row_used(as_size(S.rows()), false), col_used(as_size(S.cols()), false);
  for (Index step = 0; step < S.cols(); ++step) {
    Index row = -1, col = -1;
    double best = 1e-12;  // of rows and columns with entries up to 1
    for (Index i = 0; i < S.rows(); ++i) {
      for (Index j = 0; j < S.cols() && !row_used[as_size(i)]; ++j) {
        if (!col_used[as_size(j)] && std::abs(S(i, j)) > best) {
          best = std::abs(S(i, j));
          row = i;
          col = j;
        }
      }
    }
    if (row < 0) return std::nullopt;
    for (Index i = 0; i < S.rows(); ++i) {
      if (i != row && !row_used[as_size(i)]) S.row(i) -= S(i, col) / S(row, col) * S.row(row);
    }
    row_used[as_size(row)] = col_used[as_size(col)] = true;
    rows.push_back(row);
  }
  return rows;
}

/// |A B|, entrywise, rounded up.
Matrix product_magnitude(const Matrix& A, const Matrix& B) {
  return (linalg::product(A, B).cwiseAbs() + rounding::product_error(A, B)) *
         (1 + 4 * rounding::unit);
}

/// d > 0, powers of two, with |δ| ≤ d for all solutions of S δ = b - Aξ, ‖ξ‖∞ ≤ 1, or nothing
/// without a proof.
std::optional<Vector> solution_bounds(const Matrix& S, const Matrix& A, const Vector& b) {
  constexpr double smallest = 1e-250;
  const Index l = S.cols();
  const std::optional<Matrix> R = linalg::solve(S, Matrix::Identity(l, l));
  if (!R || !R->allFinite()) return std::nullopt;
  const Matrix E = ((Matrix::Identity(l, l) - linalg::product(*R, S)).cwiseAbs() +
                    rounding::product_error(*R, S)) *
                       (1 + 4 * rounding::unit) +
                   Matrix::Constant(l, l, 2 * rounding::unit);
  const double slightly_more = 1 + 4 * rounding::gamma(A.cols() + l + 4);
  Vector v = product_magnitude(*R, b);
  if (A.cols() > 0) v += product_magnitude(*R, A).rowwise().sum();
  v *= slightly_more;
  Vector d(l);
  for (Index k = 0; k < l; ++k) d[k] = power_of_two_above(2 * std::max(v[k], smallest));
  for (int pass = 0; pass < 10; ++pass) {
    const Vector reach = (v + linalg::product(E, d)) * slightly_more;
    if (!reach.allFinite()) return std::nullopt;
    bool proven = true;
    for (Index k = 0; k < l; ++k) {
      if (reach[k] <= 0.75 * d[k]) continue;
      proven = false;
      d[k] = power_of_two_above(2 * reach[k]);
    }
    if (proven) return d;
  }
  return std::nullopt;
}

/// A group of lines (columns of S) and all rows in which one of them is.
struct Group {
  std::vector<Index> lines, rows;
};

class Bounding {
 public:
  explicit Bounding(const LineForm& X)
      : X_(X), bounded_(as_size(X.lines()), false), row_used_(as_size(X.constraints()), false) {}

  BoundedLines run() {
    while (bound_single_lines()) {
    }
    for (const Group& group : groups()) bound(group);
    // Lines that stay
    Index kept = 0;
    for (Index j = 0; j < X_.lines(); ++j) {
      if (bounded_[as_size(j)]) continue;
      X_.M.col(kept) = X_.M.col(j);
      X_.S.col(kept++) = X_.S.col(j);
    }
    X_.M.conservativeResize(Eigen::NoChange, kept);
    X_.S.conservativeResize(Eigen::NoChange, kept);
    return {std::move(X_), std::move(pivots_)};
  }

 private:
  /// Rows with one line that is left.
  bool bound_single_lines() {
    bool any = false;
    for (Index i = 0; i < X_.constraints(); ++i) {
      if (row_used_[as_size(i)]) continue;
      Index line = -1, count = 0;
      for (Index j = 0; j < X_.lines(); ++j) {
        if (bounded_[as_size(j)] || X_.S(i, j) == 0) continue;
        line = j;
        ++count;
      }
      if (count == 1) any = bound({{line}, {i}}) || any;
      if (count == 1 && !bounded_[as_size(line)]) row_used_[as_size(i)] = true;  // not again
    }
    return any;
  }

  std::vector<Group> groups() const {
    std::vector<Group> found;
    std::vector<bool> seen(as_size(X_.lines()), false);
    for (Index first = 0; first < X_.lines(); ++first) {
      if (seen[as_size(first)] || bounded_[as_size(first)]) continue;
      Group group;
      group.lines.push_back(first);
      seen[as_size(first)] = true;
      std::vector<bool> row_seen(as_size(X_.constraints()), false);
      for (std::size_t k = 0; k < group.lines.size(); ++k) {
        for (Index i = 0; i < X_.constraints(); ++i) {
          if (row_seen[as_size(i)] || X_.S(i, group.lines[k]) == 0) continue;
          row_seen[as_size(i)] = true;
          group.rows.push_back(i);
          for (Index j = 0; j < X_.lines(); ++j) {
            if (seen[as_size(j)] || bounded_[as_size(j)] || X_.S(i, j) == 0) continue;
            seen[as_size(j)] = true;
            group.lines.push_back(j);
          }
        }
      }
      found.push_back(std::move(group));
    }
    return found;
  }

  /// Turns the lines of the group into factors if its rows bound them.
  bool bound(const Group& group) {
    const Index l = static_cast<Index>(group.lines.size());
    if (static_cast<Index>(group.rows.size()) < l) return false;
    Matrix S(static_cast<Index>(group.rows.size()), l);
    for (Index k = 0; k < l; ++k) {
      for (Index i = 0; i < S.rows(); ++i)
        S(i, k) = X_.S(group.rows[as_size(i)], group.lines[as_size(k)]);
    }
    const Vector row_scale = linalg::row_scales(S);
    S = row_scale.asDiagonal() * S;
    const Vector line_scale = linalg::row_scales(S.transpose());
    S = S * line_scale.asDiagonal();
    if (((S.array() != 0) && (S.array().abs() < 1e-200)).any())
      return false;  // scaling may have lost digits
    const auto pivots = pivot_rows(S);
    if (!pivots) return false;
    std::vector<Index> rows;
    Vector scale(l);
    for (Index k = 0; k < l; ++k) {
      rows.push_back(group.rows[as_size((*pivots)[as_size(k)])]);
      scale[k] = row_scale[(*pivots)[as_size(k)]];
    }
    Vector right(l);
    for (Index k = 0; k < l; ++k) right[k] = scale[k] * X_.b[rows[as_size(k)]];
    const Matrix factors = scale.asDiagonal() * chosen(X_.A, rows);
    if (!factors.allFinite() || !right.allFinite()) return false;
    const auto bounds = solution_bounds(chosen(S, *pivots), factors, right);
    if (!bounds) return false;
    const Index n = X_.dim(), m = X_.constraints(), g = X_.generators();
    Matrix G(n, l), A(m, l);
    for (Index k = 0; k < l; ++k) {
      const double d = (*bounds)[k] * line_scale[k];
      if (!scaled_exactly(X_.M.col(group.lines[as_size(k)]), d, G.col(k)) ||
          !scaled_exactly(X_.S.col(group.lines[as_size(k)]), d, A.col(k)))
        return false;
    }
    X_.G.conservativeResize(Eigen::NoChange, g + l);
    X_.A.conservativeResize(Eigen::NoChange, g + l);
    X_.G.rightCols(l) = G;
    X_.A.rightCols(l) = A;
    for (Index k = 0; k < l; ++k) {
      bounded_[as_size(group.lines[as_size(k)])] = true;
      row_used_[as_size(rows[as_size(k)])] = true;
      pivots_.push_back({rows[as_size(k)], g + k});
    }
    return true;
  }

  /// y = d x for a power of two d; false if a digit is lost.
  static bool scaled_exactly(VectorIn x, double d, Eigen::Ref<Vector> y) {
    y = d * x;
    return y.allFinite() && (y / d).cwiseEqual(x).all();
  }

  LineForm X_;
  std::vector<bool> bounded_, row_used_;
  std::vector<BoundedLines::Pivot> pivots_;
};

}  // namespace

BoundedLines bound_lines(const LineForm& X) {
  if (X.lines() == 0) return {X, {}};
  return Bounding(X).run();
}

}  // namespace cordon
