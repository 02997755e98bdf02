// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/interval.hpp"

#include <vector>

#include "cordon/core/recycled.hpp"
#include "cordon/core/tolerances.hpp"
#include "require.hpp"

namespace cordon::sets {

namespace {

Interval coordinate(const Box& X, Index i) { return {X.lower[i], X.upper[i]}; }

/// Stores an interval; one that is not finite on both sides becomes the whole line.
void store(Box& X, Index i, Interval x) {
  if (!x.is_finite()) x = real_line;
  X.lower[i] = x.lower;
  X.upper[i] = x.upper;
}

Interval matrix_entry(const IntervalMatrix& A, Index i, Index j) {
  const double center = A.center(i, j), radius = A.radius(i, j);
  return {directed::plus(center, -radius).lower, directed::plus(center, radius).upper};
}

/// The hull of T V in row i.
Interval image_row(const Box& V, MatrixIn T, Index i) {
  Interval sum{0, 0};
  for (Index j = 0; j < T.cols(); ++j) {
    if (T(i, j) == 0) continue;
    if (!coordinate(V, j).is_finite()) return real_line;
    sum = sum + T(i, j) * coordinate(V, j);
  }
  return sum.is_finite() ? sum : real_line;
}

using Row = Eigen::Ref<const Eigen::RowVectorXd, 0, Eigen::InnerStride<>>;

/// Rounding errors of the nominal operations that made a measurement or a box, relative to their
/// terms: less is no proof of emptiness.

enum class Progress { none, some, empty };

/// Contracts a box by one condition Σ_j row_j x_j ∈ y with y bounded. The sums of the other terms
/// come from running sums from the left and from the right. A single free coordinate can be
/// contracted; two or more block the row.
class RowContractor {
 public:
  /// `off`: y may be off by this share of its terms.
  RowContractor(Index n, double off) : after_(static_cast<std::size_t>(n) + 1), off_(off) {}

  /// `size`: of the terms that y was computed from.
  Progress contract(Box& X, const Row& row, Interval y, double size) {
    const Index n = X.dim();
    Index free = -1, frees = 0;
    for (Index j = 0; j < n; ++j) {
      if (row[j] == 0 || coordinate(X, j).is_finite()) continue;
      free = j;
      ++frees;
    }
    if (frees > 1) return Progress::none;
    after(n) = {0, 0};
    double terms = std::max(size, largest(y));
    for (Index j = n - 1; j >= 0; --j) {
      const Interval own = term(X, row, j);
      after(j) = after(j + 1) + own;
      terms += largest(own);
    }
    const double doubt = tolerances::proof_margin * terms, room = off_ * terms;
    if (room > tolerances::proof_margin * (y.upper - y.lower)) y = y + Interval{-room, room};
    if (frees == 0 && (after(0).lower - y.upper > doubt || y.lower - after(0).upper > doubt))
      return Progress::empty;
    Progress progress = Progress::none;
    Interval before{0, 0};
    for (Index j = 0; j < n; ++j) {
      const Interval own = term(X, row, j);
      if (row[j] != 0 && (frees == 0 || j == free)) {
        const Interval others = before + after(j + 1);
        const Progress step = tighten(X, j, (y - others) / row[j], doubt / std::abs(row[j]));
        if (step == Progress::empty) return step;
        if (step == Progress::some) progress = step;
      }
      before = before + own;
    }
    return progress;
  }

 private:
  Interval& after(Index j) { return after_[static_cast<std::size_t>(j)]; }

  /// row_j x_j, with 0 for a free coordinate (it is then the only one and left out of its own
  /// `others`).
  static Interval term(const Box& X, const Row& row, Index j) {
    if (row[j] == 0 || !coordinate(X, j).is_finite()) return {0, 0};
    return row[j] * coordinate(X, j);
  }

  static double largest(Interval x) { return std::max(std::abs(x.lower), std::abs(x.upper)); }

  /// X_j ∩ x. They are called disjoint only if they are apart by more than `doubt`; nearer, X_j
  /// stays as it is.
  static Progress tighten(Box& X, Index j, Interval x, double doubt) {
    if (!x.is_finite()) return Progress::none;
    const double lower = std::max(X.lower[j], x.lower), upper = std::min(X.upper[j], x.upper);
    if (lower > upper) return lower - upper > doubt ? Progress::empty : Progress::none;
    const double old_width = X.upper[j] - X.lower[j], width = upper - lower;
    X.lower[j] = lower;
    X.upper[j] = upper;
    return std::isinf(old_width) || old_width - width > 1e-9 * old_width ? Progress::some
                                                                         : Progress::none;
  }

  RecycledVector<Interval> after_;
  double off_;
};

}  // namespace

void check(const Box& X, const char* what) {
  require_size(X.upper.size(), X.lower.size(), what, "the upper bound");
  for (Index i = 0; i < X.dim(); ++i) {
    const Interval x = coordinate(X, i);
    if (x.is_finite() || (x.lower == real_line.lower && x.upper == real_line.upper)) continue;
    const std::string where = std::string(what) + ": coordinate " + std::to_string(i);
    if (std::isnan(x.lower) || std::isnan(x.upper))
      throw Error(Errc::not_finite, where + " has a NaN bound");
    throw Error(Errc::invalid,
                where + " is bounded on one side only; give two finite bounds or none");
  }
}

bool has_monomial_rows(MatrixIn C) {
  for (Index i = 0; i < C.rows(); ++i) {
    if ((C.row(i).array() != 0).count() > 1) return false;
  }
  return true;
}

bool is_monomial(MatrixIn T) {
  for (Index j = 0; j < T.cols(); ++j) {
    if ((T.col(j).array() != 0).count() > 1) return false;
  }
  return has_monomial_rows(T);
}

Box affine_map(const Box& X, MatrixIn T, VectorIn t) {
  check(X, "affine map of a box");
  require_map(T, X.dim(), "affine map of a box", "the matrix");
  require_size(t.size(), T.rows(), "affine map of a box", "the translation");
  require_finite(t, "affine map of a box", "the translation");
  if (X.is_empty()) return Box::empty(T.rows());
  Box Y = Box::space(T.rows());
  for (Index i = 0; i < T.rows(); ++i) {
    const Interval image = image_row(X, T, i);
    if (image.is_finite()) store(Y, i, image + Interval{t[i], t[i]});
  }
  return Y;
}

Box minkowski_sum(const Box& X, const Box& Y) {
  check(X, "sum of boxes");
  check(Y, "sum of boxes");
  require_size(Y.dim(), X.dim(), "sum of boxes", "the second box");
  if (X.is_empty() || Y.is_empty()) return Box::empty(X.dim());
  Box Z = Box::space(X.dim());
  for (Index i = 0; i < X.dim(); ++i) {
    const Interval x = coordinate(X, i), y = coordinate(Y, i);
    if (x.is_finite() && y.is_finite()) store(Z, i, x + y);
  }
  return Z;
}

Box affine_sum(const Box& X, MatrixIn A, VectorIn f, std::span<const MappedBox> summands) {
  constexpr const char* name = "sum of mapped boxes";
  check(X, name);
  require_map(A, X.dim(), name, "the matrix");
  require_size(f.size(), A.rows(), name, "the translation");
  require_finite(f, name, "the translation");
  bool empty = X.is_empty();
  for (const MappedBox& summand : summands) {
    check(summand.set, name);
    require_map(summand.T, summand.set.dim(), name, "a summand's matrix");
    require_size(summand.T.rows(), A.rows(), name, "the rows of a summand's matrix");
    empty = empty || summand.set.is_empty();
  }
  if (empty) return Box::empty(A.rows());
  Box Y{Vector(A.rows()), Vector(A.rows())};
  for (Index i = 0; i < A.rows(); ++i) {
    Interval sum = image_row(X, A, i);
    if (sum.is_finite()) sum = sum + Interval{f[i], f[i]};
    for (std::size_t k = 0; k < summands.size() && sum.is_finite(); ++k) {
      const Interval image = image_row(summands[k].set, summands[k].T, i);
      sum = image.is_finite() ? sum + image : real_line;
    }
    store(Y, i, sum);
  }
  return Y;
}

Box cartesian_product(const Box& X, const Box& Y) {
  check(X, "product of boxes");
  check(Y, "product of boxes");
  if (X.is_empty() || Y.is_empty()) return Box::empty(X.dim() + Y.dim());
  Box Z{Vector(X.dim() + Y.dim()), Vector(X.dim() + Y.dim())};
  Z.lower << X.lower, Y.lower;
  Z.upper << X.upper, Y.upper;
  return Z;
}

Box intersection(const Box& X, const Box& Y) {
  check(X, "intersection of boxes");
  check(Y, "intersection of boxes");
  require_size(Y.dim(), X.dim(), "intersection of boxes", "the second box");
  if (X.is_empty() || Y.is_empty()) return Box::empty(X.dim());
  Box Z{X.lower.cwiseMax(Y.lower), X.upper.cwiseMin(Y.upper)};
  return Z.is_empty() ? Box::empty(X.dim()) : Z;
}

Box interval_map(const Box& X, const IntervalMatrix& A) {
  check(X, "interval map of a box");
  require_map(A.center, X.dim(), "interval map of a box", "the centre");
  require_map(A.radius, X.dim(), "interval map of a box", "the radius");
  require_size(A.radius.rows(), A.rows(), "interval map of a box", "the radius");
  if (A.radius.size() > 0 && A.radius.minCoeff() < 0) {
    throw Error(Errc::invalid, "interval map of a box: a radius is negative; radii are at least 0");
  }
  if (X.is_empty()) return Box::empty(A.rows());
  Box Y = Box::space(A.rows());
  for (Index i = 0; i < A.rows(); ++i) {
    Interval sum{0, 0};
    for (Index j = 0; j < X.dim(); ++j) {
      if (A.center(i, j) == 0 && A.radius(i, j) == 0) continue;
      const Interval x = coordinate(X, j), a = matrix_entry(A, i, j);
      sum = x.is_finite() && a.is_finite() ? sum + a * x : real_line;
      if (!sum.is_finite()) break;
    }
    store(Y, i, sum);
  }
  return Y;
}

Box convex_hull(const Box& X, const Box& Y) {
  check(X, "hull of boxes");
  check(Y, "hull of boxes");
  require_size(Y.dim(), X.dim(), "hull of boxes", "the second box");
  if (X.is_empty()) return Y.is_empty() ? Box::empty(X.dim()) : Y;
  if (Y.is_empty()) return X;
  return {X.lower.cwiseMin(Y.lower), X.upper.cwiseMax(Y.upper)};
}

Box contract(const Box& X, MatrixIn C, VectorIn z, MatrixIn T, const Box& V, double off) {
  constexpr const char* name = "contraction of a box";
  check(X, name);
  check(V, name);
  require_map(C, X.dim(), name, "C");
  require_map(T, V.dim(), name, "T");
  require_size(z.size(), C.rows(), name, "z");
  require_size(T.rows(), C.rows(), name, "the number of rows of T");
  require_finite(z, name, "z");
  if (X.is_empty() || V.is_empty()) return Box::empty(X.dim());
  RecycledVector<Interval> y(static_cast<std::size_t>(C.rows()));
  Vector size = z.cwiseAbs();  // z - T V cancels where the sets touch
  for (Index i = 0; i < C.rows(); ++i) {
    const Interval noise = image_row(V, T, i);
    for (Index j = 0; j < T.cols(); ++j) {
      if (T(i, j) != 0)
        size[i] += std::abs(T(i, j)) * std::max(std::abs(V.lower[j]), std::abs(V.upper[j]));
    }
    y[static_cast<std::size_t>(i)] = noise.is_finite() ? Interval{z[i], z[i]} - noise : noise;
  }
  Box Y = X;
  RowContractor rows(X.dim(), off);
  for (int sweep = 0; sweep < 20; ++sweep) {
    bool progress = false;
    for (Index i = 0; i < C.rows(); ++i) {
      const Interval range = y[static_cast<std::size_t>(i)];
      if (!range.is_finite()) continue;
      const Progress step = rows.contract(Y, C.row(i), range, size[i]);
      if (step == Progress::empty) return Box::empty(X.dim());
      progress |= step == Progress::some;
    }
    if (!progress) break;
  }
  return Y;
}

}  // namespace cordon::sets
