// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/error_widths.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "observers/rounding_room.hpp"
#include "saved_state.hpp"

namespace cordon::estimators {

namespace {

/// Of the smallest width so far: columns that add no more in all times to come count as decayed.
/// So does what is far above underflow, and far below any width.
constexpr double negligible_part = 1e-16;
constexpr double decayed = 1e-250;

/// Columns that add at most this share to every half width may be replaced by their box. With 10 or
/// 30 % of all outputs missing at random, half widths were then within 1 % of those of all columns
/// in the mean, and within 11 % at worst; with 1/16, within 42 %.
constexpr double boxed_share = 1. / 64;
/// More are not kept, whatever their box adds.
constexpr Index most_columns = 2048;
/// Of the half widths: a box this small waits for others before it becomes columns.
constexpr double waiting_part = 1e-9;

Vector reach_of_columns(const Matrix& Z) { return Z.cwiseAbs().rowwise().sum(); }

/// Z with the columns that matter least replaced by n columns of the box around them.
Matrix with_small_ones_boxed(const Matrix& Z) {
  const Vector sizes = reach_of_columns(Z);
  if (!sizes.allFinite()) return Z;
  const Vector scale = (sizes.array() > decayed).select(sizes.cwiseInverse(), 0.0);
  const Matrix shares = scale.asDiagonal() * Z.cwiseAbs();
  const Vector largest = shares.colwise().maxCoeff().transpose();
  std::vector<Index> order(static_cast<std::size_t>(Z.cols()));
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return largest[a] < largest[b]; });
  const Index least = Z.cols() + Z.rows() - most_columns;
  Vector boxed = Vector::Zero(Z.rows()), share = boxed;
  Index taken = 0;
  for (; taken < Z.cols(); ++taken) {
    const Index j = order[static_cast<std::size_t>(taken)];
    share += shares.col(j);
    if (taken >= least && share.maxCoeff() > boxed_share) break;
    boxed += Z.col(j).cwiseAbs();
  }
  if (taken <= Z.rows()) return Z;
  const std::vector<Index> kept(order.begin() + taken, order.end());
  Matrix made(Z.rows(), Z.cols() - taken + Z.rows());
  boxed *= 1 + rounding::gamma(taken + 2);
  made << Z(Eigen::all, kept), Matrix(boxed.asDiagonal());
  return made;
}

}  // namespace

ErrorWidths::ErrorWidths(Rounded M, Rounded D)
    : M_(std::move(M)),
      D_(std::move(D)),
      memory_(M_.value),
      size_(M_.value.cwiseAbs()),
      tail_(memory_.sum_of_norms()),
      noise_(columns(D_)),
      start_(columns({Matrix(M_.value.rows(), 0), Matrix(M_.value.rows(), 0)})),
      sum_(Vector::Zero(M_.value.rows())),
      limit_(fewest_boxed()) {}

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
  is_after_gap_ = false;
  limit_ = fewest_boxed();
}

void ErrorWidths::keep(State& state) const {
  state.noise = noise_;
  state.start = start_;
  state.sum = sum_;
  state.steps = steps_;
  state.is_after_gap = is_after_gap_;
  state.limit = limit_;
}

void ErrorWidths::go_back(const State& state) {
  noise_ = *state.noise;
  start_ = *state.start;
  sum_ = state.sum;
  steps_ = state.steps;
  is_after_gap_ = state.is_after_gap;
  limit_ = state.limit;
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
  if (is_after_gap_) end_gap();
}

/// The columns of a gap are many. Once they add little they are replaced by their box.
void ErrorWidths::end_gap() {
  const Vector sizes = reach_of_columns(start_.value);
  if (start_.value.cols() <= sizes.size()) {
    is_after_gap_ = false;
    return;
  }
  if (!(sizes.array() <= boxed_share * (sizes + sum_).array()).all()) return;
  const Vector box = (sizes + start_.off.bound()) * (1 + rounding::gamma(start_.value.cols() + 4));
  start_.value = box.asDiagonal();
  start_.off = memory_;
  is_after_gap_ = false;
  limit_ = fewest_boxed();
}

/// Columns of all that the errors consist of. `box` is what they are off by: it grows by what the
/// columns leave out, and is among them where that is much.
Matrix ErrorWidths::gathered(Vector& box) const {
  const Index n = sum_.size(), m = D_.value.cols();
  const auto terms = steps_ + static_cast<double>(m) + 16;
  Vector left = sum_ * (1 + 8 * terms * rounding::unit);  // of the sums of noise
  const Vector little = boxed_share * left;
  std::vector<Matrix> powers;
  for (Index made = 0; made < most_columns && static_cast<double>(powers.size()) < steps_ &&
                       (left.array() > little.array()).any();
       made += m) {
    powers.push_back(powers.empty() ? D_.value : linalg::product(M_.value, powers.back()));
    left -= reach_of_columns(powers.back());
  }
  box += start_.past + start_.off.bound() + left.cwiseMax(0.0);
  box *= 1 + 8 * rounding::unit;
  Matrix all(n, start_.value.cols() + static_cast<Index>(powers.size()) * m + n);
  all.leftCols(start_.value.cols()) = start_.value;
  Index at = start_.value.cols();
  for (const Matrix& power : powers) {
    all.middleCols(at, m) = power;
    at += m;
  }
  if ((box.array() <= waiting_part * reach_of_columns(all.leftCols(at)).array()).all())
    return all.leftCols(at);
  all.rightCols(n) = box.asDiagonal();
  box.setZero();
  return all;
}

void ErrorWidths::step_by(const Rounded& M, const Rounded& D, VectorIn off) {
  Vector box = off;
  Matrix all = gathered(box);
  if (all.cols() > limit_) {
    all = with_small_ones_boxed(all);
    limit_ = std::max(2 * all.cols(), fewest_boxed());
  }
  const Index n = all.rows(), r = all.cols(), m = D.value.cols();
  const Vector sizes = reach_of_columns(all);
  const Matrix M_size = M.value.cwiseAbs();
  const Vector lost = rounding::gamma(n + 4) * (M_size * sizes) + M.error * sizes + M_size * box +
                      M.error * box + D.error.rowwise().sum() +
                      Vector::Constant(n, static_cast<double>(r) * 1e-300);
  Matrix next(n, r + m);
  linalg::product(M.value, all, next.leftCols(r));
  next.rightCols(m) = D.value;
  noise_ = columns(D_);
  start_ = {std::move(next), memory_, Vector::Zero(n)};
  start_.off.step(2 * lost);
  sum_.setZero();
  steps_ = 0;
  is_after_gap_ = true;
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

void ErrorWidths::serialize(Archive& archive) {
  State state;
  keep(state);
  serialize(state, archive);
  if (archive.is_reading()) go_back(state);
}

void ErrorWidths::serialize(State& state, Archive& archive) const {
  const Index n = sum_.size();
  for (std::optional<Columns>* part : {&state.noise, &state.start}) {
    if (!*part || archive.is_reading()) *part = Columns{Matrix(n, 0), memory_, Vector::Zero(n)};
    archive((*part)->value, (*part)->off, (*part)->past);
    if ((*part)->value.rows() != n || (*part)->past.size() != n)
      archive.refuse("errors of another dimension");
  }
  archive(state.sum, state.steps, state.is_after_gap);
  serialize_within(archive, state.limit, 0, Index{1} << 60);
  const bool has_noise = D_.value.cols() > 0;
  if (state.sum.size() != n || !(state.steps >= 0) || (!has_noise && !state.sum.isZero(0)))
    archive.refuse("no half widths of errors");
}

}  // namespace cordon::estimators
