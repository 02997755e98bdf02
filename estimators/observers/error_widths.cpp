// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/error_widths.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "observers/rounding_room.hpp"

namespace cordon::estimators {

namespace {

/// Of the smallest width so far: columns that add no more in all times to come count as decayed.
/// So does what is far above underflow, and far below any width.
constexpr double negligible_part = 1e-16;
constexpr double decayed = 1e-250;

}  // namespace

ErrorWidths::ErrorWidths(Rounded M, Rounded D)
    : M_(std::move(M)),
      D_(std::move(D)),
      memory_(M_.value),
      size_(M_.value.cwiseAbs()),
      tail_(memory_.sum_of_norms()),
      noise_(columns(D_)),
      start_(columns({Matrix(M_.value.rows(), 0), Matrix(M_.value.rows(), 0)})),
      sum_(Vector::Zero(M_.value.rows())) {}

ErrorWidths::Columns ErrorWidths::columns(const Rounded& Z) const {
  Columns made{Z.value, memory_, Vector::Zero(Z.value.rows())};
  made.off.step(2 * Z.error.rowwise().sum());
  return made;
}

void ErrorWidths::start(const Rounded& R) {
  noise_ = columns(D_);
  start_ = columns(R);
  sum_.setZero();
  steps_ = 0;
}

void ErrorWidths::keep(State& state) const {
  state.noise = noise_;
  state.start = start_;
  state.sum = sum_;
  state.steps = steps_;
}

void ErrorWidths::go_back(const State& state) {
  noise_ = *state.noise;
  start_ = *state.start;
  sum_ = state.sum;
  steps_ = state.steps;
}

/// At least |Z| 1.
void ErrorWidths::add_sum_of(const Columns& Z, Vector& to) const {
  to += Z.past;
  if (Z.value.cols() == 0) return;
  to += Z.value.cwiseAbs().rowwise().sum();
  Z.off.add_bound(to);
}

void ErrorWidths::move_on(Columns& Z) const {
  if (Z.value.cols() == 0) return;
  const Vector sizes = Z.value.cwiseAbs().rowwise().sum();
  const Index n = M_.value.rows();
  // twice, for what the memory's own powers are off by
  const Vector lost = 2 * (rounding::gamma(n + 4) * (size_ * sizes) + M_.error * sizes +
                           Vector::Constant(n, static_cast<double>(Z.value.cols()) * 1e-300));
  Z.off.step(lost);
  Z.value = linalg::product(M_.value, Z.value);
}

/// What has decayed adds |Mʲ Z| 1 ≤ ‖Mʲ‖∞ ‖Z‖∞ in steps to come, no more than tail ‖Z‖∞ in all of
/// them together.
void ErrorWidths::forget(Columns& Z) const {
  if (Z.value.cols() == 0 || !std::isfinite(tail_)) return;
  const double limit = std::max(decayed, negligible_part / tail_ * sum_.minCoeff());
  const double most = row_norm(Z.value);
  if (!(most <= limit)) return;
  const double off = Z.off.bound().maxCoeff();
  if (!(off <= limit)) return;
  Z.past.array() += 2 * tail_ * (most + off);
  Z.off = memory_;
  Z.value = Matrix(Z.value.rows(), 0);
}

void ErrorWidths::step() {
  if (noise_.value.cols() > 0) {
    Vector sum = Vector::Zero(sum_.size());
    add_sum_of(noise_, sum);
    sum_ += sum;
    move_on(noise_);
    forget(noise_);
    if (noise_.value.cols() == 0) sum_ += noise_.past;
    ++steps_;
  }
  move_on(start_);
  forget(start_);
}

void ErrorWidths::step_by(const Rounded& M, const Rounded& D) {
  const Vector from = half_widths();
  const Vector size = (M.value.cwiseAbs() + M.error) * from +
                      Vector((D.value.cwiseAbs() + D.error).rowwise().sum());
  const Matrix box =
      (size * (1 + rounding::gamma(4 * (from.size() + D.value.cols()) + 8))).asDiagonal();
  start({box, Matrix::Zero(box.rows(), box.cols())});
}

void ErrorWidths::take_half_widths(Vector& into) const {
  const auto terms = steps_ + static_cast<double>(D_.value.cols() + start_.value.cols()) + 16;
  into = sum_;
  add_sum_of(start_, into);
  into *= 1 + 4 * terms * rounding::unit;
}

Vector ErrorWidths::half_widths() const {
  Vector half;
  take_half_widths(half);
  return half;
}

}  // namespace cordon::estimators
