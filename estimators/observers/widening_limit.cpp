// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/widening_limit.hpp"

#include <limits>

#include "cordon/core/linalg.hpp"
#include "cordon/core/tolerances.hpp"
#include "saved_state.hpp"

namespace cordon::estimators {

namespace {

/// |Fᵏ| Σ_{j<k} |Fʲ| as a share of that sum, from which on all later powers count for nothing.
constexpr double negligible_share = 1e-10;
/// Rounding errors of the sums, as a share of them: far above those, far below what the limit is
/// about.
constexpr double rounding_share = 1e-9;

Vector absolute_row_sums(const Matrix& M) { return M.cwiseAbs().rowwise().sum(); }

}  // namespace

ErrorHull::ErrorHull(Matrix F, Matrix N, Vector start)
    : F_(std::move(F)),
      power_(Matrix::Identity(F_.rows(), F_.rows())),
      N_(std::move(N)),
      noise_(N_),
      powers_(Matrix::Zero(F_.rows(), F_.rows())),
      start_(std::move(start)),
      sum_(Vector::Zero(F_.rows())) {}

void ErrorHull::step(const Vector& b) {
  if (b.size() > 0) b_ = b_.size() > 0 ? Vector(b_.cwiseMax(b)) : b;
  if (settled_) return;
  sum_ += absolute_row_sums(noise_);
  powers_ += power_.cwiseAbs();
  noise_ = linalg::product(F_, noise_);
  power_ = linalg::product(F_, power_);
  if (++steps_ % 8 == 0) settle();  // which costs as much as a step
}

/// With P = Σ_{j<k} |Fʲ| and |Fᵏ| P ≤ η P every later block of k powers is at most η of the one
/// before: Σ_{j≥k} |Fʲ| ≤ 2 η P, whatever b will be.
void ErrorHull::settle() {
  constexpr double left_over = 2 * negligible_share;
  const Matrix next = power_.cwiseAbs() * powers_;
  settled_ = (next.array() <= negligible_share * powers_.array()).all();
  if (!settled_) return;
  sum_ += left_over * (powers_ * (absolute_row_sums(N_) + start_));
  powers_ *= 1 + left_over;
}

Vector ErrorHull::half_widths() const {
  Vector h = sum_ + power_.cwiseAbs() * start_;
  if (b_.size() > 0) h += powers_ * b_;
  return h * (1 + rounding_share);
}

void ErrorHull::serialize(Archive& archive) {
  for (Matrix* part : {&power_, &noise_, &powers_}) archive.same_shape(*part);
  for (Vector* part : {&start_, &sum_}) archive.same_shape(*part);
  archive(b_, settled_);
  serialize_within(archive, steps_, 0, Index{1} << 60);
  if (b_.size() != 0 && b_.size() != sum_.size()) archive.refuse("half widths of another size");
}

void WideningLimit::start(const LuenbergerRecursion& recursion, const Enclosure& X) {
  errors_.reset();
  if (limit_ == 0 || recursion.backend().info().rounding == Rounding::outward) return;
  const Box hull = X->interval_hull();
  if (hull.is_empty() || !hull.is_bounded()) return;
  center_ = (hull.lower + hull.upper) / 2;
  const Vector half = (hull.upper - center_).cwiseMax(center_ - hull.lower);
  errors_.emplace(recursion.error_map(), recursion.error_noise(), half);
}

/// By how much the next center is off, whose terms may cancel.
Vector WideningLimit::rounding_of(const LuenbergerRecursion& recursion,
                                  const Sample& before) const {
  return tolerances::product_noise * recursion.next_size(center_, before);
}

void WideningLimit::step(const LuenbergerRecursion& recursion, const Sample& before,
                         const Vector& open) {
  if (!errors_) return;
  const Vector rounding = rounding_of(recursion, before);
  center_ = recursion.next(center_, before);
  errors_->step(open.size() > 0 ? Vector(open + rounding) : rounding);
}

void WideningLimit::step_with_gap(const LuenbergerRecursion& recursion,
                                  const LuenbergerRecursion& others, const Sample& before,
                                  const Vector& open) {
  if (!errors_) return;
  const Vector rounding = rounding_of(others, before);
  center_ = others.next(center_, before);
  Vector h = rounding + others.error_map().cwiseAbs() * errors_->half_widths() +
             absolute_row_sums(others.error_noise());
  if (open.size() > 0) h += open;
  errors_.emplace(recursion.error_map(), recursion.error_noise(), h * (1 + rounding_share));
}

void WideningLimit::serialize(Archive& archive, const LuenbergerRecursion& recursion) {
  bool has_errors = errors_.has_value();
  archive(has_errors);
  if (archive.is_reading()) errors_.reset();
  if (!has_errors) return;
  const Index n = recursion.error_map().rows();
  if (!errors_) errors_.emplace(recursion.error_map(), recursion.error_noise(), Vector::Zero(n));
  archive(*errors_, center_);
  if (center_.size() != n) archive.refuse("a centre of another size");
}

Enclosure WideningLimit::apply(const SetBackend& backend, const Enclosure& X, Box* known) const {
  if (known) *known = {};
  if (!errors_) return X;
  const Complexity size = X->complexity();
  if (size.constraints > 0 || size.lines > 0) return X;
  const Vector half = errors_->half_widths() + rounding_share * center_.cwiseAbs();
  if (!half.allFinite()) return X;
  Box hull = X->interval_hull();
  if (known) *known = hull;
  if (((hull.upper - hull.lower).array() <= 2 * limit_ * half.array()).all()) return X;
  // both hold the state; where a coordinate is known exactly they may lie beside each other by
  // what rounding made of each, which is no proof that there is nothing in both
  const Vector lower = hull.lower.cwiseMax(center_ - half),
               upper = hull.upper.cwiseMin(center_ + half);
  hull = {lower.cwiseMin(upper), lower.cwiseMax(upper)};
  if (known) *known = hull;
  Enclosure box = backend.box(hull);
  box.tightness = Tightness::outer;
  return box;
}

}  // namespace cordon::estimators
