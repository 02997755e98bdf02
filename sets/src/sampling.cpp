// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/solvers/boxed_program.hpp"

namespace cordon::sets {

namespace {

constexpr double line_range = 10;

/// Some (δ, ξ) that satisfies the constraints with the smallest ‖ξ‖∞. Multipliers P with PᵀS = 0
/// leave rows in ξ alone.
std::optional<Vector> central_factors(const LineForm& X) {
  const Matrix P = linalg::null_space(X.S.transpose());
  BoxedProgram program(linalg::transposed_product(P, X.A), linalg::transposed_product(P, X.b));
  const std::optional<Vector> xi = program.central_point();
  if (!xi) return std::nullopt;
  Vector factors(X.lines() + X.generators());
  factors << linalg::product(linalg::pseudo_inverse(X.S), X.b - linalg::product(X.A, *xi)), *xi;
  return factors;
}

/// Constraint rows scaled to unit length.
LineForm equilibrated(LineForm X) {
  for (Index i = 0; i < X.constraints(); ++i) {
    const double length = std::hypot(X.S.row(i).stableNorm(), X.A.row(i).stableNorm());
    if (length == 0) continue;
    X.S.row(i) /= length;
    X.A.row(i) /= length;
    X.b[i] /= length;
  }
  return X;
}

/// Hit-and-run: a random chord of {z₀ + Nt : |z_i - m_i| ≤ r_i} through the present point, a
/// uniform point on it.
class Walk {
 public:
  Walk(Vector start, Matrix N, Vector middle, Vector radius)
      : start_(std::move(start)),
        N_(std::move(N)),
        middle_(std::move(middle)),
        radius_(std::move(radius)),
        t_(Vector::Zero(N_.cols())) {}

  Vector point() const { return start_ + linalg::product(N_, t_); }

  void step(Random& random) {
    const Vector direction = random.cube(N_.cols());
    const Vector along = linalg::product(N_, direction), offset = point() - middle_;
    double first = -infinity, last = -first;
    for (Index i = 0; i < along.size(); ++i) {
      if (along[i] == 0) continue;
      const double a = (-radius_[i] - offset[i]) / along[i],
                   b = (radius_[i] - offset[i]) / along[i];
      first = std::max(first, std::min(a, b));
      last = std::min(last, std::max(a, b));
    }
    const double s = random.unit();
    if (std::isfinite(first) && std::isfinite(last) && first < last)
      t_ += (first + s * (last - first)) * direction;
  }

 private:
  Vector start_;
  Matrix N_;
  Vector middle_, radius_, t_;
};

}  // namespace

Vector Random::cube(Index n) {
  Vector x(n);
  for (double& value : x) value = between(-1, 1);
  return x;
}

std::optional<Matrix> sample(const LineForm& X, Index count, std::uint64_t seed) {
  check(X, "sampled set");
  if (count < 0) throw Error(Errc::invalid, "sampling: the number of points is negative");
  Random random(seed);
  const Index lines = X.lines(), factors = lines + X.generators();
  Matrix map(X.dim(), factors);
  map << X.M, X.G;
  Matrix points(X.dim(), count);
  if (X.constraints() == 0) {
    for (Index k = 0; k < count; ++k) {
      Vector z = random.cube(factors);
      z.head(lines) *= line_range;
      points.col(k) = X.c + linalg::product(map, z);
    }
    return points;
  }
  const LineForm Y = equilibrated(X);
  const std::optional<Vector> start = central_factors(Y);
  if (!start || (start->tail(X.generators()).array().abs() > 1 + 1e-9).any()) return std::nullopt;
  Matrix rows(X.constraints(), factors);
  rows << Y.S, Y.A;
  if ((linalg::product(rows, *start) - Y.b).lpNorm<Eigen::Infinity>() >
      1e-9 * (1 + start->lpNorm<Eigen::Infinity>())) {
    return std::nullopt;
  }
  Vector middle = Vector::Zero(factors), radius = Vector::Ones(factors);
  middle.head(lines) = start->head(lines);
  radius.head(lines).setConstant(line_range);
  Walk walk(*start, linalg::null_space(rows), middle, radius);
  const Index warm_up = 10 * factors;
  for (Index k = -warm_up; k < count; ++k) {
    walk.step(random);
    if (k >= 0) points.col(k) = X.c + linalg::product(map, walk.point());
  }
  return points;
}

}  // namespace cordon::sets
