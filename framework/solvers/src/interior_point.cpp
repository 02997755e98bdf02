// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/interior_point.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cordon/core/linalg.hpp"
#include "cordon/solvers/limits.hpp"

namespace cordon {

namespace {

constexpr Index most_rounds = 40, most_refinements = 3, group_size = 32;
constexpr double enough = 1e-9;    ///< gap between bound and value, of 1 + |value|
constexpr double almost = 0.9995;  ///< of the way to the nearest bound

/// The largest step ≤ 1 along `change` that keeps x ≥ 0, not quite.
double step_within(const Vector& x, const Vector& change) {
  double step = 1;
  for (Index j = 0; j < x.size(); ++j) {
    if (change[j] < 0) step = std::min(step, -almost * x[j] / change[j]);
  }
  return step;
}

}  // namespace

InteriorPoint::InteriorPoint(const Matrix& A, VectorIn b) : A_(A), b_(b) { arrange(); }

void InteriorPoint::arrange() {
  const Index m = A_.rows(), g = A_.cols();
  std::vector<Index> begins(static_cast<std::size_t>(g));
  for (Index j = 0; j < g; ++j) {
    Index first = m, entries = 0;
    for (Index i = 0; i < m; ++i) {
      if (A_(i, j) == 0) continue;
      first = std::min(first, i);
      ++entries;
    }
    begins[static_cast<std::size_t>(j)] = first;
    if (entries == 1) singles_.push_back({first, j});
    if (entries > 1) order_.push_back(j);
  }
  const auto begin = [&](Index j) { return begins[static_cast<std::size_t>(j)]; };
  std::stable_sort(order_.begin(), order_.end(),
                   [&](Index i, Index j) { return begin(i) < begin(j); });
  const auto count = static_cast<Index>(order_.size());
  for (Index first = 0; first < count; first += group_size) {
    groups_.push_back({begin(order_[static_cast<std::size_t>(first)]), first,
                       std::min(group_size, count - first)});
  }
  sorted_ = A_(Eigen::all, order_);
  scaled_.resize(m, group_size);
}

/// How far ξ and the multipliers can go.
std::pair<double, double> InteriorPoint::lengths(const Direction& step) const {
  return {std::min(step_within(to_upper_, -step.xi), step_within(to_lower_, step.xi)),
          std::min(step_within(above_, step.above), step_within(below_, step.below))};
}

/// The mean of z⁺(1 - ξ) and z⁻(1 + ξ), now and after the step as far as it can go.
double InteriorPoint::centrality() const {
  return (to_upper_.dot(above_) + to_lower_.dot(below_)) / (2.0 * static_cast<double>(A_.cols()));
}

double InteriorPoint::centrality_after(const Direction& step) const {
  const auto [primal, dual] = lengths(step);
  const double sum = (to_upper_ - primal * step.xi).dot(above_ + dual * step.above) +
                     (to_lower_ + primal * step.xi).dot(below_ + dual * step.below);
  return sum / (2.0 * static_cast<double>(A_.cols()));
}

/// Of A D⁻¹ Aᵀ.
bool InteriorPoint::factor() {
  const Index m = A_.rows();
  normal_.setZero(m, m);
  for (const Group& group : groups_) {
    const Index height = m - group.row;
    auto part = scaled_.block(0, 0, height, group.count);
    for (Index k = 0; k < group.count; ++k) {
      const Index j = group.first + k;
      part.col(k) =
          sorted_.col(j).tail(height) / std::sqrt(D_[order_[static_cast<std::size_t>(j)]]);
    }
    normal_.bottomRightCorner(height, height).selfadjointView<Eigen::Lower>().rankUpdate(part);
  }
  for (const auto& [row, col] : singles_)
    normal_(row, row) += A_(row, col) * A_(row, col) / D_[col];
  if (!normal_.diagonal().allFinite()) return false;
  const auto found = linalg::cholesky(normal_);
  if (!found) return false;
  factor_ = *found;
  return true;
}

/// v ← (A D⁻¹ Aᵀ)⁻¹ v.
void InteriorPoint::solve_normal(Vector& v) const {
  factor_.triangularView<Eigen::Lower>().solveInPlace(v);
  factor_.triangularView<Eigen::Lower>().transpose().solveInPlace(v);
}

/// The step that meets rows and costs and changes z⁺(1 - ξ), z⁻(1 + ξ) by the rests, to first
/// order.
void InteriorPoint::solve(const Vector& rest_above, const Vector& rest_below,
                          Direction& step) const {
  const Vector push =
      costs_left_ - rest_above.cwiseQuotient(to_upper_) + rest_below.cwiseQuotient(to_lower_);
  step.y = linalg::product(A_, push.cwiseQuotient(D_)) - rows_left_;
  solve_normal(step.y);
  step.xi = (push - linalg::transposed_product(A_, step.y)).cwiseQuotient(D_);
  // Near the optimum D spans many orders of magnitude: the step as computed would leave the rows.
  for (Index k = 0; k < most_refinements; ++k) {
    Vector missed = linalg::product(A_, step.xi) - rows_left_;
    if (!(missed.lpNorm<Eigen::Infinity>() > enough / 100)) break;
    solve_normal(missed);
    step.y += missed;
    step.xi -= linalg::transposed_product(A_, missed).cwiseQuotient(D_);
  }
  step.above = (rest_above + above_.cwiseProduct(step.xi)).cwiseQuotient(to_upper_);
  step.below = (rest_below - below_.cwiseProduct(step.xi)).cwiseQuotient(to_lower_);
}

bool InteriorPoint::maximize(VectorIn g) {
  if (!LimitedSolvers::may_begin()) return false;
  const Index m = A_.rows(), cols = A_.cols();
  xi_ = Vector::Zero(cols);
  y_ = Vector::Zero(m);
  above_ = g.cwiseMax(0.0).array() + 1;
  below_ = (-g).cwiseMax(0.0).array() + 1;
  Direction step;
  for (Index round = 0; round < most_rounds; ++round) {
    if (LimitedSolvers::is_over()) return false;
    to_upper_ = 1 - xi_.array();
    to_lower_ = 1 + xi_.array();
    rows_left_ = b_ - linalg::product(A_, xi_);
    const Vector reduced = g - linalg::transposed_product(A_, y_);
    costs_left_ = reduced - above_ + below_;
    value_ = g.dot(xi_);
    D_ = above_.cwiseQuotient(to_upper_) + below_.cwiseQuotient(to_lower_);
    const double gap = b_.dot(y_) + reduced.lpNorm<1>() - value_,
                 tolerance = enough * (1 + std::abs(value_));
    if (!std::isfinite(gap)) return false;
    if (std::abs(gap) <= tolerance && rows_left_.lpNorm<Eigen::Infinity>() <= enough) return true;
    if (!factor()) return false;
    const double mu = centrality();
    solve(-to_upper_.cwiseProduct(above_), -to_lower_.cwiseProduct(below_), step);
    const double target = mu * std::pow(centrality_after(step) / mu, 3);
    const Vector above =
        target - (to_upper_.cwiseProduct(above_) - step.xi.cwiseProduct(step.above)).array();
    const Vector below =
        target - (to_lower_.cwiseProduct(below_) + step.xi.cwiseProduct(step.below)).array();
    solve(above, below, step);
    const auto [primal, dual] = lengths(step);
    xi_ += primal * step.xi;
    y_ += dual * step.y;
    above_ += dual * step.above;
    below_ += dual * step.below;
  }
  return false;
}

}  // namespace cordon
