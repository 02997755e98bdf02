// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/row_certificates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/core/rounding.hpp"

namespace cordon {

using rounding::down;
using rounding::gamma;
using rounding::up;

RowCertificates::RowCertificates(const Matrix& A, VectorIn b, VectorIn error)
    : cols_(A.cols()),
      panels_(A),
      b_(b),
      error_(error),
      reach_(cols_ ? Vector(A.cwiseAbs().rowwise().sum()) : Vector::Zero(A.rows())),
      exact_(error.isZero(0)) {
  reach_ *= up(1 + 2 * gamma(cols_ + 2));
}

/// What an uncertain right-hand side adds to bᵀy at most.
double RowCertificates::doubt(VectorIn y) const {
  return exact_ ? 0.0 : rounding::dot(error_, y.cwiseAbs()).upper;
}

double RowCertificates::upper_bound(VectorIn g, VectorIn y) const {
  return up(up(rounding::dot(b_, y).upper + residual(g.data(), y)) + doubt(y));
}

double RowCertificates::farkas_margin(VectorIn y) const {
  if (!y.allFinite()) return -infinity;
  return down(down(rounding::dot(b_, y).lower - residual(nullptr, y)) - doubt(y));
}

/// ≥ ‖g - Aᵀy‖₁. A column is off by γ (|g_j| + Σ|A_ij||y_i|) at most, all of them by γ (‖g‖₁ + Σ
/// reach_i |y_i|).
double RowCertificates::residual(const double* g, VectorIn y) const {
  constexpr Index width = Panels<double>::width;
  double sums[width] = {}, sizes[width] = {};
  for (Index p = 0; p < panels_.panels(); ++p) {
    double value[width];
    panels_.transpose_times(p, y.data()).store(value);
    const Index here = g ? std::min(width, cols_ - p * width) : 0;
    for (Index k = 0; k < here; ++k) {
      sums[k] += std::abs(g[p * width + k] - value[k]);
      sizes[k] += std::abs(g[p * width + k]);
    }
    if (!g) {
      for (Index k = 0; k < width; ++k) sums[k] += std::abs(value[k]);
    }
  }
  double total = 0, size = 0;
  for (Index k = 0; k < width; ++k) {
    total += sums[k];
    size += sizes[k];
  }
  const Index m = panels_.rows();
  const double terms = up(up(size * (1 + 2 * gamma(cols_ + 8))) +
                          up(reach_.dot(y.cwiseAbs()) * (1 + 2 * gamma(m + 2))));
  const double underflow = static_cast<double>((m + 2) * (cols_ + 2)) * rounding::tiny;
  return up(up(total * (1 + 2 * gamma(cols_ + 8))) + up(up(gamma(m + 4) * terms) + underflow));
}

}  // namespace cordon
