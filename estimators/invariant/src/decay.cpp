// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/minimal.hpp"
#include "cordon/invariant/schur.hpp"
#include "weights.hpp"

namespace cordon::invariant {

namespace {

using linalg::product;

constexpr int most_squarings = 50;
constexpr double smallest_weight = 1e-9;  // relative to the largest
constexpr double enough = 0.5;

/// A nonnegative sum of n terms, each with a few roundings, made an upper bound.
double raised(double value, Index n) { return value * (1 + 2 * rounding::gamma(n + 8)); }

}  // namespace

Vector decay_weights(MatrixIn A, VectorIn size) {
  const Index n = A.rows();
  Vector weights = size;
  Matrix power = Matrix::Identity(n, n);
  for (Index k = 0; k < 4 * n + 8; ++k) {
    power = product(power, A);
    weights += product(power.cwiseAbs(), size);
  }
  const double largest = n == 0 ? 0.0 : weights.maxCoeff();
  if (!(largest > 0) || !weights.allFinite()) return Vector::Ones(n);
  return weights.cwiseMax(smallest_weight * largest);
}

Decay::Decay(MatrixIn A, VectorIn size, const std::string& what) : A_(A) {
  require_schur(A, what);
  const Index n = A_.rows();
  if (size.size() != n) throw Error(Errc::dimension, "the sizes of a decay bound need one entry per state");
  if (!size.allFinite()) throw Error(Errc::not_finite, "the sizes of a decay bound are not finite");
  weights_ = decay_weights(A_, size.cwiseAbs());
  magnitude_ = product(A_.cwiseAbs(), weights_);
  if (n == 0) return;
  Matrix power = A_, error = Matrix::Zero(n, n);
  for (int squarings = 0; squarings < most_squarings; ++squarings) {
    const Matrix bound = power.cwiseAbs() + error;
    const double norm = raised((product(bound, weights_).array() / weights_.array()).maxCoeff(), n);
    if (!std::isfinite(norm)) break;
    if (norm <= enough) {
      sum_ = raised(sum_ / (1 - norm), 8);
      return;
    }
    sum_ = raised(sum_ * (1 + norm), 8);
    const Matrix magnitude = power.cwiseAbs();
    error =
        (product(magnitude, error) + product(error, magnitude) + product(error, error) + rounding::product_error(power, power)) *
        (1 + 2 * rounding::gamma(2 * n + 16));
    power = product(power, power);
  }
  throw Error(Errc::unsupported,
              "no decay of the powers of " + what + " can be proven: its largest eigenvalue is too near to the unit circle");
}

double Decay::norm(VectorIn r) const { return raised(r.cwiseAbs().dot(weights_), dim()); }

double Decay::share(const sets::Zonotope& D) const {
  if (dim() == 0) return 0;
  Vector size = D.c.cwiseAbs();
  if (D.G.cols() > 0) size += D.G.cwiseAbs().rowwise().sum();
  return raised((size.array() / weights_.array()).maxCoeff(), D.G.cols() + 1);
}

double Decay::product_error(VectorIn r) const {
  const double terms = r.cwiseAbs().dot(magnitude_.col(0)),
               underflow = rounding::tiny * static_cast<double>(dim() + 1) * weights_.sum();
  return raised(rounding::gamma(2 * dim() + 4) * terms + underflow, dim());
}

}  // namespace cordon::invariant
