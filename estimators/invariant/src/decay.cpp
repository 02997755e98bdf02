// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/minimal.hpp"
#include "cordon/invariant/schur.hpp"
#include "raised.hpp"
#include "weights.hpp"

namespace cordon::invariant {

namespace {

using linalg::product;

constexpr int most_levels = 12;
constexpr std::size_t terms_per_level = 16;
constexpr double enough_decay = 0.5;

/// A matrix that is known up to an error.
struct Bounded {
  Matrix value, error;
  Matrix bound() const { return value.cwiseAbs() + error; }
};

Bounded multiplied(const Bounded& X, const Bounded& Y) {
  const Matrix error = product(X.error, Y.bound()) + product(X.value.cwiseAbs(), Y.error) +
                       rounding::product_error(X.value, Y.value);
  return {product(X.value, Y.value), error * (1 + 2 * rounding::gamma(2 * X.value.rows() + 16))};
}

}  // namespace

Vector decay_weights(MatrixIn A, VectorIn size) {
  const Index n = A.rows();
  Vector weights = size;
  Matrix power = Matrix::Identity(n, n);
  for (Index k = 0; k < 4 * n + 8; ++k) {
    power = product(power, A);
    weights += product(power.cwiseAbs(), size);
  }
  double smallest = infinity;
  for (const double w : weights) smallest = w > 0 ? std::min(smallest, w) : smallest;
  if (!std::isfinite(smallest) || !weights.allFinite()) return Vector::Ones(n);
  return (weights.array() > 0).select(weights, smallest);
}

Decay::Decay(MatrixIn A, VectorIn size, const std::string& what) : A_(A) {
  if (A_.rows() != A_.cols()) throw Error(Errc::dimension, "a decay bound needs a square matrix");
  if (!A_.allFinite()) throw Error(Errc::not_finite, "a decay bound needs finite entries");
  const Index n = A_.rows();
  if (size.size() != n)
    throw Error(Errc::dimension, "the sizes of a decay bound need one entry per state");
  if (!size.allFinite()) throw Error(Errc::not_finite, "the sizes of a decay bound are not finite");
  weights_ = decay_weights(A_, size.cwiseAbs());
  magnitude_ = product(A_.cwiseAbs(), weights_);
  if (n == 0) return;
  // Σ_k ‖Aᵏ‖ over k = a + 16 b + 256 c + …, one factor per digit
  Bounded base{A_, Matrix::Zero(n, n)};
  for (int level = 0; level < most_levels; ++level) {
    double terms = 1;  // ‖I‖
    std::vector<Bounded> powers{
        base, base};  // by exponent; 0 is not used. Halving exponents keeps errors small
    for (std::size_t k = 1; k < terms_per_level; ++k) {
      const double norm =
          raised((product(powers[k].bound(), weights_).array() / weights_.array()).maxCoeff(), n);
      if (norm <= enough_decay) {
        sum_ = raised(sum_ * terms / (1 - norm), 64);
        return;
      }
      terms = raised(terms + norm, 8);
      powers.push_back(multiplied(powers[(k + 1) / 2], powers[(k + 1) - (k + 1) / 2]));
    }
    sum_ = raised(sum_ * terms, 8);
    if (!std::isfinite(sum_)) break;
    base = powers.back();
  }
  require_schur(A, what);
  throw Error(Errc::unsupported,
              "no decay of the powers of " + what +
                  " can be proven: its largest eigenvalue is too near to the unit circle");
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
