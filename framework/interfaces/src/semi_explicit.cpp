// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/semi_explicit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/descriptor_matrix.hpp"
#include "solvers/rational.hpp"

namespace cordon {

namespace {

using rational::Rational;
using rational::RationalMatrix;

std::vector<Index> others(const std::vector<Index>& chosen, Index n) {
  std::vector<Index> rest;
  for (Index i = 0; i < n; ++i) {
    if (std::find(chosen.begin(), chosen.end(), i) == chosen.end()) rest.push_back(i);
  }
  return rest;
}

/// Errc::not_finite for numbers beyond the range of doubles.
double in_doubles(const Rational& q, bool& is_exact) {
  const double nearest = rational::nearest(q);
  if (!std::isfinite(nearest))
    throw Error(Errc::not_finite,
                "an equation of the descriptor system, solved for its states, overflows");
  is_exact = is_exact && Rational(nearest) == q;
  return nearest;
}

SemiExplicitForm::Part rounded(const RationalMatrix& A) {
  SemiExplicitForm::Part part{Matrix(A.rows(), A.cols()), true};
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < A.cols(); ++j) part.rows(i, j) = in_doubles(A(i, j), part.is_exact);
  }
  return part;
}

/// [E_RP⁻¹, E_RP⁻¹ E_RQ].
RationalMatrix solved_core(MatrixIn E, const DescriptorMatrix::Pivots& pivots,
                           const std::vector<Index>& Q) {
  const auto r = static_cast<Index>(pivots.rows.size());
  RationalMatrix rows(r, 2 * r + static_cast<Index>(Q.size()));
  for (Index i = 0; i < r; ++i) {
    const Index row = pivots.rows[static_cast<std::size_t>(i)];
    for (Index j = 0; j < r; ++j)
      rows(i, j) = rational::exact(E(row, pivots.cols[static_cast<std::size_t>(j)]));
    rows(i, r + i) = 1;
    for (std::size_t j = 0; j < Q.size(); ++j)
      rows(i, 2 * r + static_cast<Index>(j)) = rational::exact(E(row, Q[j]));
  }
  if (static_cast<Index>(reduce_rows(rows, r).size()) < r)
    throw Error(Errc::invalid, "the pivots of E are not regular");
  RationalMatrix out(r, rows.cols() - r);
  for (Index i = 0; i < r; ++i) {
    for (Index j = 0; j < out.cols(); ++j) out(i, j) = rows(i, r + j);
  }
  return out;
}

}  // namespace

struct SemiExplicitForm::Rows {
  RationalMatrix dynamic, fixed;
};

SemiExplicitForm::SemiExplicitForm(Index n)
    : rank_(n), T_(Matrix::Identity(n, n)), T_inverse_(T_) {}

SemiExplicitForm::SemiExplicitForm(MatrixIn E) {
  DescriptorMatrix::Pivots pivots = DescriptorMatrix::pivots_of(E);
  std::sort(pivots.rows.begin(), pivots.rows.end());
  std::sort(pivots.cols.begin(), pivots.cols.end());
  const Index n = E.rows();
  rank_ = static_cast<Index>(pivots.rows.size());
  const std::vector<Index> Q = others(pivots.cols, n), S = others(pivots.rows, n);
  const RationalMatrix core = solved_core(E, pivots, Q);
  RationalMatrix dynamic(rank_, n), fixed(n - rank_, n);
  for (Index i = 0; i < rank_; ++i) {
    for (Index j = 0; j < rank_; ++j)
      dynamic(i, pivots.rows[static_cast<std::size_t>(j)]) = core(i, j);
  }
  for (Index i = 0; i < n - rank_; ++i) {
    const Index row = S[static_cast<std::size_t>(i)];
    for (Index k = 0; k < rank_; ++k) {
      const double coefficient = E(row, pivots.cols[static_cast<std::size_t>(k)]);
      if (coefficient == 0) continue;
      for (Index j = 0; j < n; ++j) fixed(i, j) -= Rational(coefficient) * dynamic(k, j);
    }
    fixed(i, row) = 1;
  }
  rows_ = std::make_shared<const Rows>(Rows{std::move(dynamic), std::move(fixed)});

  T_ = T_inverse_ = Matrix::Zero(n, n);
  for (Index i = 0; i < rank_; ++i) T_(pivots.cols[static_cast<std::size_t>(i)], i) = 1;
  for (Index j = 0; j < n - rank_; ++j) T_(Q[static_cast<std::size_t>(j)], rank_ + j) = 1;
  T_inverse_ = T_.transpose();
  for (Index i = 0; i < rank_; ++i) {
    for (Index j = 0; j < n - rank_; ++j) {
      const double share = in_doubles(core(i, rank_ + j), is_exact_);
      T_(pivots.cols[static_cast<std::size_t>(i)], rank_ + j) = share == 0 ? 0 : -share;
      T_inverse_(i, Q[static_cast<std::size_t>(j)]) = share;
    }
  }
}

SemiExplicitForm::Part SemiExplicitForm::dynamic_part(MatrixIn M) const {
  if (!rows_) return {M, true};
  return rounded(product(rows_->dynamic, rational::exact_matrix(M)));
}

SemiExplicitForm::Part SemiExplicitForm::static_part(MatrixIn M) const {
  if (!rows_) return {Matrix(0, M.cols()), true};
  return rounded(product(rows_->fixed, rational::exact_matrix(M)));
}

SemiExplicitForm::Part SemiExplicitForm::dynamic_part_of_state(MatrixIn A) const {
  if (!rows_) return {A, true};
  return rounded(
      product(rows_->dynamic, product(rational::exact_matrix(A), rational::exact_matrix(T_))));
}

SemiExplicitForm::Part SemiExplicitForm::static_part_of_state(MatrixIn A) const {
  if (!rows_) return {Matrix(0, A.cols()), true};
  return rounded(
      product(rows_->fixed, product(rational::exact_matrix(A), rational::exact_matrix(T_))));
}

SemiExplicitForm::Part SemiExplicitForm::outputs_of_state(MatrixIn C) const {
  if (!rows_) return {C, true};
  return rounded(product(rational::exact_matrix(C), rational::exact_matrix(T_)));
}

}  // namespace cordon
