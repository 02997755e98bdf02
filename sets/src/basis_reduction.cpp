// SPDX-License-Identifier: GPL-3.0-or-later
#include "basis_reduction.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "cordon/core/tolerances.hpp"
#include "cordon/core/workspace.hpp"
#include "nonzero_columns.hpp"
#include "row_scales.hpp"
#include "rows.hpp"

namespace cordon::sets {

namespace {

/// A pivot below this part of its row's scale does not count: the row is then left to the slack of
/// `BasisReduction`.
/// Rounding level of the elimination, relative to a row's scale: below it a computed residual is
/// not distinguishable from 0.

/// Method 4 of [Yang2018]: G = [T V] with a basis T of large columns found by full pivoting, R =
/// T⁻¹V. Replacing T and v_j by T (I + diag|r_j|) adds the volume ∏(1 + |r_ij|) - 1 - Σ|r_ij| (in
/// units of det T); the cheapest column goes first. A flat G has fewer pivots than rows; what the
/// basis leaves of a removed column in the other rows goes to their slack, one axis-parallel
/// generator per row: where elimination computed it, without what is rounding; a column without
/// entries in the rows of pivots was not computed, and is as wide as it is, however narrow (room
/// for rounded data is). Observers reduce in every step: memory is kept.
class BasisReduction {
 public:
  /// Of G the columns that are not zero.
  void take(MatrixIn G) {
    take_nonzero_columns(G, G_);
    take_row_scales(G_, scale_);
    take_padded_rows(G_, W_);
    for (Index i = 0; i < W_.rows(); ++i) W_.row(i) *= scale_[i];
    number(row_, G_.rows());
    number(order_, G_.cols());
    eliminate();
  }

  void exchange(WorkspaceExchange& memory) {
    memory.swap(G_, scale_, W_, row_, order_, growth_, slack_, kept_, sum_, cost_);
  }

  Matrix reduce(Index max_generators) {
    Index slacks = 0;
    for (Index i = rank_; i < G_.rows(); ++i) slacks += has_residual(at(row_, i)) ? 1 : 0;
    return assemble(absorb_cheapest(max_generators - slacks));
  }

  /// Every row without a pivot is given a unit vector, so that the basis is one of ℝⁿ.
  ReductionSplit split(Index max_generators) {
    const Index n = G_.rows(), g = G_.cols(), last = absorb_cheapest(max_generators - (n - rank_));
    ReductionSplit parts{columns(rank_, last), Matrix(n, rank_ + g - last), Matrix::Zero(n, n),
                         true};
    parts.replaced << columns(0, rank_), columns(last, g);
    parts.basis.leftCols(rank_) = columns(0, rank_);
    for (Index i = rank_; i < n; ++i) parts.basis(at(row_, i), i) = 1;
    return parts;
  }

 private:
  using Numbers = std::vector<Index>;
  static void number(Numbers& all, Index count) {
    all.resize(static_cast<std::size_t>(count));
    std::iota(all.begin(), all.end(), Index{0});
  }
  static Index at(const Numbers& numbers, Index i) { return numbers[static_cast<std::size_t>(i)]; }
  static void swap(Numbers& numbers, Index i, Index j) {
    std::swap(numbers[static_cast<std::size_t>(i)], numbers[static_cast<std::size_t>(j)]);
  }
  double* row(Index i) { return W_.data() + i * W_.cols(); }
  const double* row(Index i) const { return W_.data() + i * W_.cols(); }

  /// G's columns in places first … last-1 of the order.
  Matrix columns(Index first, Index last) const {
    Matrix some(G_.rows(), last - first);
    for (Index k = first; k < last; ++k) some.col(k - first) = G_.col(at(order_, k));
    return some;
  }

  /// Is there more than rounding in a row without a pivot?
  bool has_residual(Index i) const {
    for (Index k = rank_; k < G_.cols(); ++k) {
      const double size = std::abs(W_(i, at(order_, k)));
      if (size > tolerances::product_noise || (size > 0 && !is_computed(at(order_, k))))
        return true;
    }
    return false;
  }

  /// Has elimination changed the column?
  bool is_computed(Index column) const {
    for (Index p = 0; p < rank_; ++p)
      if (W_(at(row_, p), column) != 0) return true;
    return false;
  }

  /// W = [I R; 0 E] in the order of rows and columns, by Gauss-Jordan steps with pivots over the
  /// whole of E.
  void eliminate() {
    const Index n = G_.rows(), g = G_.cols();
    for (rank_ = 0; rank_ < std::min(n, g) && put_pivot_first(); ++rank_) {
      const Index pivot_row = at(row_, rank_), column = at(order_, rank_);
      W_.row(pivot_row) /= W_(pivot_row, column);
      for (Index i = 0; i < n; ++i) {
        const double factor = W_(i, column);
        if (i != pivot_row && factor != 0)
          vectors::add_multiple(W_.cols(), -factor, row(pivot_row), row(i));
      }
    }
  }

  /// The largest entry of E; false if none counts.
  bool put_pivot_first() {
    sum_.setZero(W_.cols());
    for (Index i = rank_; i < G_.rows(); ++i) {
      const double* const entries = row(at(row_, i));
      double* const largest = sum_.data();
      for (Index j = 0; j < W_.cols(); ++j) {
        const double size = std::abs(entries[j]);
        largest[j] = largest[j] < size ? size : largest[j];
      }
    }
    Index place = rank_;
    for (Index k = rank_; k < G_.cols(); ++k) {
      if (sum_[at(order_, k)] > sum_[at(order_, place)]) place = k;
    }
    const double pivot = sum_[at(order_, place)];
    if (!(pivot > tolerances::rank)) return false;
    swap(order_, rank_, place);
    for (Index i = rank_; i < G_.rows(); ++i) {
      if (std::abs(W_(at(row_, i), at(order_, rank_))) != pivot) continue;
      swap(row_, rank_, i);
      break;
    }
    return true;
  }

  /// Absorbs columns until `most` are left, and returns how many are.
  Index absorb_cheapest(Index most) {
    growth_ = Vector::Ones(rank_);
    slack_ = Vector::Zero(G_.rows() - rank_);
    kept_ = slack_;
    Index last = G_.cols();  // places rank_ … last-1 are left in V
    while (last > most) {
      const Index cheapest = cheapest_place(last);
      absorb(at(order_, cheapest));
      swap(order_, cheapest, --last);
    }
    return last;
  }

  /// The volume error is summed without cancellation: q collects the terms of second and higher
  /// order.
  Index cheapest_place(Index last) {
    sum_.setZero(W_.cols());
    cost_.setZero(W_.cols());
    double* const sum = sum_.data();
    double* const cost = cost_.data();
    for (Index i = 0; i < rank_; ++i) {
      const double* const entries = row(at(row_, i));
      const double inverse = 1 / growth_[i];
      for (Index j = 0; j < W_.cols(); ++j) {
        const double r = std::abs(entries[j]) * inverse;
        cost[j] += r * (sum[j] + cost[j]);
        sum[j] += r;
      }
    }
    Index best = rank_;
    for (Index k = rank_; k < last; ++k) {
      if (cost_[at(order_, k)] < cost_[at(order_, best)]) best = k;
    }
    return best;
  }

  void absorb(Index column) {
    for (Index i = 0; i < rank_; ++i) growth_[i] += std::abs(W_(at(row_, i), column));
    const bool is_kept = slack_.size() > 0 && !is_computed(column);
    for (Index i = 0; i < slack_.size(); ++i)
      (is_kept ? kept_ : slack_)[i] += std::abs(W_(at(row_, rank_ + i), column));
  }

  Matrix assemble(Index last) const {
    const Index n = G_.rows(), g = G_.cols();
    Matrix H = Matrix::Zero(n, last + slack_.size());
    for (Index k = 0; k < last; ++k)
      H.col(k) = (k < rank_ ? growth_[k] : 1.0) * G_.col(at(order_, k));
    Index count = last;
    for (Index i = 0; i < slack_.size(); ++i) {
      const bool is_noise = slack_[i] <= tolerances::product_noise * static_cast<double>(g - last);
      const double slack = (is_noise ? 0.0 : slack_[i]) + kept_[i];
      if (!(slack > 0)) continue;
      const Index place = at(row_, rank_ + i);
      H(place, count++) = slack / scale_[place];
    }
    H.conservativeResize(Eigen::NoChange, count);
    return H;
  }

  Matrix G_;
  Vector scale_;
  Rows W_;
  Numbers row_, order_;  ///< W's rows and columns in the order of their pivots
  Index rank_ = 0;
  Vector growth_, slack_, kept_;  ///< slack of columns that were computed, and of the others
  Vector sum_, cost_;             ///< per column: the largest entry, then a row's part of the costs
};

}  // namespace

Matrix reduce_into_basis(MatrixIn G, Index max_generators) {
  WithWorkspace<BasisReduction> basis(WorkspaceOf::generator_reduction);
  basis->take(G);
  return basis->reduce(max_generators);
}

ReductionSplit split_into_basis(MatrixIn G, Index max_generators) {
  WithWorkspace<BasisReduction> basis(WorkspaceOf::generator_reduction);
  basis->take(G);
  return basis->split(max_generators);
}

}  // namespace cordon::sets
