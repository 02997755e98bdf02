// SPDX-License-Identifier: GPL-3.0-or-later
#include "support_query.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/core/linalg.hpp"
#include "require.hpp"

namespace cordon::sets {

namespace {
/// A number of this size is the outward rounding of 0; its inverse would overflow.
constexpr double underflow = 1e-290;
}  // namespace

ScaledSet::ScaledSet(const SupportOracle& X, Index n, const char* operation)
    : oracle_(X),
      operation_(operation),
      center_(Vector::Zero(n)),
      width_(Vector::Ones(n)),
      shift_(Vector::Zero(n)),
      B_(Matrix::Identity(n, n)),
      inverse_(B_) {
  for (Index i = 0; i < n && !empty_; ++i) {
    const SupportPoint above = ask(Vector::Unit(n, i)), below = ask(-Vector::Unit(n, i));
    empty_ = above.h == -infinity || below.h == -infinity;
    if (empty_) break;
    const double width = above.h + below.h, magnitude = std::abs(above.h) + std::abs(below.h);
    center_[i] = above.h / 2 - below.h / 2;
    // a width at rounding level counts as none: scaled up, it would show nothing but noise
    const bool none = !(width > std::max(1e-14 * magnitude, underflow));
    flat_ |= none;
    if (!none || magnitude > underflow) width_[i] = none ? magnitude : width / 2;
  }
}

SupportPoint ScaledSet::ask(const Vector& d) const {
  SupportPoint answer = oracle_(d);
  if (std::isnan(answer.h))
    throw Error(Errc::not_finite, std::string(operation_) + ": the support function returned NaN");
  if (answer.h == infinity) {
    throw Error(Errc::unsupported,
                std::string(operation_) +
                    ": the set is unbounded or its bound is not known; intersect it with a box");
  }
  if (answer.h != -infinity) {
    require_size(answer.x.size(), d.size(), operation_, "the support point");
    require_finite(answer.x, operation_, "the support point");
  }
  return answer;
}

SupportPoint ScaledSet::query(const Vector& d) const {
  const Vector scaled = linalg::transposed_product(inverse_, d),
               direction = scaled.cwiseQuotient(width_);
  const double length = direction.stableNorm();
  const SupportPoint answer = ask(direction / length);
  if (answer.h == -infinity)
    throw Error(Errc::invalid,
                std::string(operation_) + ": the set is empty in one direction only");
  const Vector point = (answer.x - center_).cwiseQuotient(width_) - shift_;
  return {answer.h * length - direction.dot(center_) - scaled.dot(shift_),
          linalg::product(inverse_, point)};
}

Vector ScaledSet::direction(const Vector& d) const {
  return linalg::transposed_product(inverse_, d).cwiseQuotient(width_);
}

double ScaledSet::thickness(const Vector& d) const {
  const Vector across = direction(d);
  const double length = across.stableNorm();
  const double above = ask(across / length).h, below = ask(-across / length).h;
  // a support value is off by a few units in the last place of its terms, which may cancel: of the
  // centre's, and of generators as long as the hull
  const double terms = across.cwiseAbs().dot(center_.cwiseAbs() + width_);
  const double noise = 64 * std::numeric_limits<double>::epsilon() * terms;
  const bool point = above + below == 0 && width_.cwiseAbs().dot(across.cwiseAbs()) == 0;
  return point ? 0 : std::max(0.0, (above + below) * length) + noise;
}

bool ScaledSet::transform(const Vector& shift, const Matrix& B) {
  const std::optional<Matrix> inverse = linalg::solve(B, Matrix::Identity(B.rows(), B.cols()));
  if (!inverse) return false;
  shift_ = shift;
  B_ = B;
  inverse_ = *inverse;
  return true;
}

Matrix ScaledSet::restore(const Matrix& points) const {
  const Matrix scaled = linalg::product(B_, points).colwise() + shift_;
  return (width_.asDiagonal() * scaled).colwise() + center_;
}

double ScaledSet::volume_factor() const {
  return std::abs(linalg::determinant(B_)) * width_.prod();
}

}  // namespace cordon::sets
