// SPDX-License-Identifier: GPL-3.0-or-later
#include "polytope_images.hpp"

#include <utility>
#include <vector>

namespace cordon::plugins {

namespace {

/// In the order of bits: bit i decides over the sign of coordinate i.
Vector signs(unsigned bits, Index n) {
  Vector s(n);
  for (Index i = 0; i < n; ++i) s[i] = (bits >> i & 1U) != 0 ? -1 : 1;
  return s;
}

}  // namespace

Polytope hull_of_images(const Polytope& X, const IntervalMatrix& A) {
  const Index m = A.rows(), n = X.dim();
  Matrix sum(m, 2 * m);
  sum << Matrix::Identity(m, m), Matrix::Identity(m, m);
  std::vector<Polytope> parts;
  for (unsigned orthant = 0; orthant < 1U << n; ++orthant) {
    const Vector sign = signs(orthant, n);
    const Polytope part =
        X.intersection(Polytope::from_inequalities(-Matrix(sign.asDiagonal()), Vector::Zero(n)));
    if (part.is_empty()) continue;
    for (unsigned corner = 0; corner < 1U << m; ++corner) {
      Matrix stacked(2 * m, n);
      stacked << A.center, signs(corner, m).asDiagonal() * A.radius * sign.asDiagonal();
      parts.push_back(
          part.affine_map(stacked, Vector::Zero(2 * m)).affine_map(sum, Vector::Zero(m)));
    }
  }
  while (parts.size() > 1) {  // in pairs, so that each point takes part in few conversions
    std::vector<Polytope> hulls;
    for (std::size_t i = 0; i + 1 < parts.size(); i += 2)
      hulls.push_back(parts[i].convex_hull(parts[i + 1]));
    if (parts.size() % 2 == 1) hulls.push_back(parts.back());
    parts = std::move(hulls);
  }
  return parts.front();
}

}  // namespace cordon::plugins
