// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/generator_reduction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "reduction_split.hpp"
#include "require.hpp"
#include "row_scales.hpp"

namespace cordon::sets {

namespace {

/// A pivot below this part of its row's scale does not count: the row is then left to the slack of `BasisReduction`.
constexpr double rank_tolerance = 1e-10;
/// Rounding level of the elimination, relative to a row's scale: below it a computed residual is not distinguishable from 0.
constexpr double noise = 1e-14;

Matrix nonzero_columns(MatrixIn G) {
  Matrix kept(G.rows(), G.cols());
  Index count = 0;
  for (Index j = 0; j < G.cols(); ++j) {
    if ((G.col(j).array() != 0).any()) kept.col(count++) = G.col(j);
  }
  if (count < G.cols()) kept.conservativeResize(Eigen::NoChange, count);
  return kept;
}

/// Half widths of the interval hull, rounded up.
Vector box_radii(MatrixIn G) {
  const Vector sums = G.cwiseAbs().rowwise().sum();
  return sums * (1 + 2 * rounding::gamma(G.cols() + 2));
}

enum class Size { norm_1_minus_max, norm_2 };

/// 2-norms of the columns. The plain formula is safe, and four times faster, where no square can overflow or vanish beside the
/// others.
Vector norms(MatrixIn G) {
  constexpr double large = 1e150, small = 1e-150;
  const double most = G.size() ? G.cwiseAbs().maxCoeff() : 0.0;
  if (most < large && most > small) return G.colwise().norm().transpose();
  return G.colwise().stableNorm().transpose();
}

/// [large | small], the largest first by `size`; of equal ones the first stays first.
Matrix sorted_by_size(MatrixIn G, Size size) {
  const Vector key =
      size == Size::norm_2 ? norms(G) : Vector((G.colwise().lpNorm<1>() - G.colwise().lpNorm<Eigen::Infinity>()).transpose());
  std::vector<Index> order(static_cast<std::size_t>(G.cols()));
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return key[a] > key[b]; });
  Matrix sorted(G.rows(), G.cols());
  for (Index k = 0; k < G.cols(); ++k) sorted.col(k) = G.col(order[static_cast<std::size_t>(k)]);
  return sorted;
}

/// Replaces the columns from `kept` on by the n columns of `frame`.
Matrix with_frame(const Matrix& sorted, Index kept, MatrixIn frame) {
  Matrix H(sorted.rows(), kept + frame.cols());
  H << sorted.leftCols(kept), frame;
  return nonzero_columns(H);
}

Matrix box_reduction(const Matrix& G, Index max_generators, Size size) {
  const Index kept = max_generators - G.rows();
  const Matrix sorted = sorted_by_size(G, size);
  const Vector radii = box_radii(sorted.rightCols(sorted.cols() - kept));
  return with_frame(sorted, kept, radii.asDiagonal().toDenseMatrix());
}

/// Where the rows' scales differ by more than 2¹⁶ they are made equal before their principal axes are sought: the rounding errors
/// of the rotation would swamp the smallest coordinates otherwise.
Vector scales_of_axes(MatrixIn small) {
  Vector scale = row_scales(small);
  if (scale.maxCoeff() <= std::ldexp(scale.minCoeff(), 16)) scale.setOnes();
  return scale;
}

/// The box is taken along the left singular vectors of the small generators.
Matrix pca_reduction(const Matrix& G, Index max_generators) {
  const Index kept = max_generators - G.rows();
  const Matrix sorted = sorted_by_size(G, Size::norm_1_minus_max);
  Matrix small = sorted.rightCols(sorted.cols() - kept);
  const Vector scale = scales_of_axes(small);
  small = scale.asDiagonal() * small;
  const Matrix U = linalg::svd(small).U;
  Vector radii = box_radii(linalg::product(U.transpose(), small));
  const double largest = radii.maxCoeff();
  for (double& radius : radii) radius = radius <= noise * largest ? 0.0 : radius;
  const Matrix frame = scale.cwiseInverse().asDiagonal() * U * radii.asDiagonal();
  return with_frame(sorted, kept, frame);
}

/// Method 4 of [Yang2018]: G = [T V] with a basis T of large columns found by full pivoting, R = T⁻¹V. Replacing T and v_j
/// by T (I + diag|r_j|) adds the volume ∏(1 + |r_ij|) - 1 - Σ|r_ij| (in units of det T); the cheapest column goes first.
/// A flat G has fewer pivots than rows; what the basis leaves of a removed column in the other rows goes to their slack,
/// one axis-parallel generator per row.
class BasisReduction {
 public:
  explicit BasisReduction(const Matrix& G) : G_(G), scale_(row_scales(G)), W_(scale_.asDiagonal() * G) { eliminate(); }

  Matrix reduce(Index max_generators) {
    const Index n = W_.rows(), g = W_.cols();
    Index slacks = 0;
    for (Index i = rank_; i < n; ++i) slacks += W_.row(i).tail(g - rank_).lpNorm<Eigen::Infinity>() > noise ? 1 : 0;
    return assemble(absorb_cheapest(max_generators - slacks));
  }

  /// Every row without a pivot is given a unit vector, so that the frame is square.
  ReductionSplit split(Index max_generators) {
    const Index n = W_.rows(), g = W_.cols(), last = absorb_cheapest(max_generators - (n - rank_));
    ReductionSplit parts{G_.middleCols(rank_, last - rank_), Matrix(n, rank_ + g - last), Matrix::Zero(n, n)};
    parts.replaced << G_.leftCols(rank_), G_.rightCols(g - last);
    parts.frame.leftCols(rank_) = G_.leftCols(rank_);
    for (Index i = rank_; i < n; ++i) parts.frame(row_[static_cast<std::size_t>(i)], i) = 1;
    return parts;
  }

 private:
  /// Absorbs columns until `most` are left, and returns how many are.
  Index absorb_cheapest(Index most) {
    const Index n = W_.rows(), g = W_.cols();
    growth_ = Vector::Ones(rank_);
    slack_ = Vector::Zero(n - rank_);
    Index last = g;  // columns rank_ … last-1 are left in V
    while (last > most) {
      const Index cheapest = cheapest_column(last);
      absorb(cheapest, last);
      --last;
      W_.col(cheapest).swap(W_.col(last));
      G_.col(cheapest).swap(G_.col(last));
    }
    return last;
  }

  /// W = [I R; 0 E] by Gauss-Jordan steps with pivots over the whole remaining block; rows and columns are swapped along.
  void eliminate() {
    const Index n = W_.rows(), g = W_.cols();
    row_.resize(static_cast<std::size_t>(n));
    std::iota(row_.begin(), row_.end(), Index{0});
    for (rank_ = 0; rank_ < std::min(n, g); ++rank_) {
      const Index k = rank_;
      Index i = 0, j = 0;
      const double largest = W_.bottomRightCorner(n - k, g - k).cwiseAbs().maxCoeff(&i, &j);
      if (!(largest > rank_tolerance)) break;
      swap(k, k + i, k + j);
      Vector pivot_column = W_.col(k);
      const double pivot = pivot_column[k];
      pivot_column[k] = 0;
      for (Index column = k + 1; column < g; ++column) {
        const double factor = W_(k, column) / pivot;
        if (factor == 0) continue;
        W_.col(column) -= factor * pivot_column;
        W_(k, column) = factor;
      }
    }
  }

  void swap(Index k, Index row, Index column) {
    if (row != k) {
      W_.row(k).swap(W_.row(row));
      std::swap(row_[static_cast<std::size_t>(k)], row_[static_cast<std::size_t>(row)]);
    }
    if (column != k) {
      W_.col(k).swap(W_.col(column));
      G_.col(k).swap(G_.col(column));
    }
  }

  /// The volume error is summed without cancellation: q collects the terms of second and higher order.
  Index cheapest_column(Index last) const {
    Index best = rank_;
    double best_cost = std::numeric_limits<double>::infinity();
    for (Index j = rank_; j < last; ++j) {
      double s = 0, q = 0;
      for (Index i = 0; i < rank_; ++i) {
        const double r = std::abs(W_(i, j));
        q += r * (s + q);
        s += r;
      }
      if (q < best_cost) {
        best_cost = q;
        best = j;
      }
    }
    return best;
  }

  void absorb(Index column, Index last) {
    for (Index i = 0; i < rank_; ++i) {
      const double r = std::abs(W_(i, column));
      if (r == 0) continue;
      growth_[i] *= 1 + r;
      W_.row(i).segment(rank_, last - rank_) /= 1 + r;
    }
    for (Index i = 0; i < slack_.size(); ++i) slack_[i] += std::abs(W_(rank_ + i, column));
  }

  Matrix assemble(Index last) const {
    const Index n = W_.rows(), g = W_.cols();
    Matrix H = Matrix::Zero(n, last + slack_.size());
    H.leftCols(rank_) = G_.leftCols(rank_) * growth_.asDiagonal();
    H.middleCols(rank_, last - rank_) = G_.middleCols(rank_, last - rank_);
    Index count = last;
    for (Index i = 0; i < slack_.size(); ++i) {
      if (!(slack_[i] > noise * static_cast<double>(g - last))) continue;
      const Index row = row_[static_cast<std::size_t>(rank_ + i)];
      H(row, count++) = slack_[i] / scale_[row];
    }
    H.conservativeResize(Eigen::NoChange, count);
    return H;
  }

  Matrix G_;
  Vector scale_;
  Matrix W_;
  std::vector<Index> row_;  ///< row_[i]: the row of G that row i of W stands for
  Index rank_ = 0;
  Vector growth_, slack_;
};

}  // namespace

ReductionSplit split_generators(const Matrix& G, Index max_generators, GeneratorReduction method) {
  if (method == GeneratorReduction::yang_scott) return BasisReduction(G).split(max_generators);
  const Index n = G.rows(), kept = std::min(max_generators - n, G.cols());
  const Matrix sorted = sorted_by_size(G, method == GeneratorReduction::combastel ? Size::norm_2 : Size::norm_1_minus_max);
  const Matrix small = sorted.rightCols(sorted.cols() - kept);
  if (method != GeneratorReduction::pca) return {sorted.leftCols(kept), small, Matrix::Identity(n, n)};
  const Vector scale = scales_of_axes(small);
  return {sorted.leftCols(kept), small, scale.cwiseInverse().asDiagonal() * linalg::svd(scale.asDiagonal() * small).U};
}

Vector enclosing_radii(MatrixIn G) { return box_radii(G); }

Matrix reduce_generators(MatrixIn G, Index max_generators, GeneratorReduction method) {
  if (max_generators < G.rows()) {
    throw Error(Errc::invalid, "generator reduction: " + std::to_string(max_generators) +
                                   " generators cannot enclose a set of dimension " + std::to_string(G.rows()) +
                                   "; allow at least " + std::to_string(G.rows()));
  }
  require_finite(G, "generator reduction", "the generator matrix");
  const Matrix kept = nonzero_columns(G);
  if (kept.cols() <= max_generators) return kept;
  switch (method) {
    case GeneratorReduction::girard:
      return box_reduction(kept, max_generators, Size::norm_1_minus_max);
    case GeneratorReduction::combastel:
      return box_reduction(kept, max_generators, Size::norm_2);
    case GeneratorReduction::pca:
      return pca_reduction(kept, max_generators);
    case GeneratorReduction::yang_scott:
      return BasisReduction(kept).reduce(max_generators);
  }
  throw Error(Errc::invalid, "generator reduction: unknown method");
}

}  // namespace cordon::sets
