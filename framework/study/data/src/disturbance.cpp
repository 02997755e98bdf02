// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/disturbance.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/linalg.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "study/data/signals.hpp"

namespace cordon::detail {

namespace {

LineForm without_lines(const LineForm& X) { return X.lines() == 0 ? X : eliminate_lines(X); }

/// ξ of smallest ‖ξ‖∞ with Aξ = b.
std::optional<Vector> central_factors(const LineForm& X) {
  if (X.constraints() == 0) return Vector(Vector::Zero(X.generators()));
  std::optional<Vector> xi = BoxedProgram(X.A, X.b).central_point();
  if (!xi || !xi->allFinite() || (xi->size() > 0 && xi->cwiseAbs().maxCoeff() > 1 + 1e-9))
    return std::nullopt;
  return Vector(xi->cwiseMax(-1.0).cwiseMin(1.0));
}

bool is_prime(std::int64_t p) {
  for (std::int64_t q = 2; q * q <= p; ++q) {
    if (p % q == 0) return false;
  }
  return p >= 2;
}

/// √2, √3, √5, √7, … without the first `skipped`.
Vector incommensurate(Index skipped, Index count) {
  Vector omega(count);
  Index found = 0;
  for (std::int64_t p = 2; found < skipped + count; ++p) {
    if (!is_prime(p)) continue;
    if (found >= skipped) omega[found - skipped] = std::sqrt(static_cast<double>(p));
    ++found;
  }
  return omega;
}

}  // namespace

std::optional<Vector> central_point(const LineForm& X) {
  const LineForm Z = without_lines(X);
  const std::optional<Vector> xi = central_factors(Z);
  if (!xi) return std::nullopt;
  return Vector(Z.c + linalg::product(Z.G, *xi));
}

Disturbance::Disturbance(const LineForm& X, Noise noise, RandomStream stream, Index first_prime,
                         const std::string& file, const std::string& pointer)
    : X_(without_lines(X)), noise_(noise), stream_(stream) {
  if (X_.lines() > 0) {
    throw InputError(file, {{pointer, "cannot be simulated: unbounded",
                             "give a bounded set, or use recorded data"}});
  }
  const std::optional<Vector> anchor = central_factors(X_);
  if (!anchor) {
    const bool empty = is_empty(X_) == Answer::yes;
    throw InputError(file, {{pointer,
                             empty ? "cannot be simulated: the set is empty"
                                   : "cannot be simulated: no point of the set was found",
                             "check its constraints"}});
  }
  anchor_ = *anchor;
  if (X_.constraints() > 0) inverse_ = linalg::pseudo_inverse(X_.A);
  if (noise_ == Noise::sine) omega_ = incommensurate(first_prime, X_.generators());
}

Vector Disturbance::at(std::int64_t k) {
  if (noise_ == Noise::zero) return X_.c + linalg::product(X_.G, anchor_);
  const Vector xi = factor_draw(k);
  return X_.c + linalg::product(X_.G, X_.constraints() == 0 ? xi : into_rows(xi));
}

Vector Disturbance::factor_draw(std::int64_t k) {
  Vector xi(X_.generators());
  for (Index i = 0; i < xi.size(); ++i) {
    switch (noise_) {
      case Noise::uniform:
        xi[i] = stream_.symmetric();
        break;
      case Noise::vertex:
        xi[i] = stream_.sign();
        break;
      case Noise::sine:
        xi[i] = sine(omega_[i], k, 0);
        break;
      case Noise::zero:
        xi[i] = 0;
        break;
    }
  }
  return xi;
}

Vector Disturbance::into_rows(const Vector& xi) const {
  const Vector residual = linalg::product(X_.A, xi) - X_.b;
  const Vector direction = xi - linalg::product(inverse_, residual) - anchor_;
  double reach = infinity;  // largest t with ‖anchor + t direction‖∞ ≤ 1
  for (Index i = 0; i < direction.size(); ++i) {
    if (std::abs(direction[i]) < 1e-12) continue;  // the rows fix this factor
    const double bound = direction[i] > 0 ? 1.0 : -1.0;
    reach = std::min(reach, std::max(0.0, (bound - anchor_[i]) / direction[i]));
  }
  const double t = noise_ == Noise::vertex && std::isfinite(reach) ? reach : std::min(1.0, reach);
  return (anchor_ + t * direction).cwiseMax(-1.0).cwiseMin(1.0);
}

}  // namespace cordon::detail
