// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/rounding.hpp"

#include "cordon/core/linalg.hpp"

namespace cordon::rounding {

namespace {

/// The exact value lies within `error` of `value`; an overflow widens to the whole line.
Interval widen(double value, double error) {
  if (!std::isfinite(value) || !std::isfinite(error)) {
    return {-infinity, infinity};
  }
  return {down(value - error), up(value + error)};
}

}  // namespace

Interval sum(VectorIn x) {
  const double magnitude = x.size() ? x.cwiseAbs().sum() : 0.0;
  // the computed magnitude is itself off by at most gamma: one gamma of the next size covers both
  return widen(x.size() ? x.sum() : 0.0, up(gamma(2 * x.size() + 2) * magnitude));
}

Interval dot(VectorIn x, VectorIn y) {
  const Index n = x.size();
  if (n == 0) return {0.0, 0.0};
  const double magnitude = x.cwiseAbs().dot(y.cwiseAbs());
  return widen(x.dot(y), up(up(gamma(2 * n + 4) * magnitude) + static_cast<double>(n + 1) * tiny));
}

Interval norm_1(VectorIn x) { return sum(x.cwiseAbs()); }

Matrix product_error(MatrixIn A, MatrixIn B) {
  const Index n = A.cols();
  Matrix error = linalg::product(A.cwiseAbs(), B.cwiseAbs());
  error = (error.array() * gamma(2 * n + 4) * (1 + 4 * unit) + static_cast<double>(n + 1) * tiny)
              .matrix();
  return error;
}

double residual_norm_1(VectorIn g, MatrixIn A, VectorIn y) {
  const Index m = A.rows();
  double total = 0;  // of upper bounds, each rounded up; the sum of n terms is widened at the end
  for (Index j = 0; j < g.size(); ++j) {
    double value = g[j], magnitude = std::abs(g[j]);
    for (Index i = 0; i < m; ++i) {
      const double term = A(i, j) * y[i];
      value -= term;
      magnitude += std::abs(term);
    }
    if (m == 0) {
      total += magnitude;
    } else {
      total += up(std::abs(value) + up(gamma(2 * m + 4) * magnitude) +
                  static_cast<double>(m + 1) * tiny);
    }
  }
  return up(total * (1 + 2 * gamma(g.size() + 2)));
}

}  // namespace cordon::rounding
