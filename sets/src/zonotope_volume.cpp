// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cordon/sets/generator_reduction.hpp"
#include "cordon/sets/zonotope.hpp"
#include "determinant.hpp"
#include "subsets.hpp"

namespace cordon::sets {

double determinant(Matrix& A) {
  const Index n = A.rows();
  double product = 1;
  for (Index k = 0; k < n; ++k) {
    Index pivot = 0;
    A.col(k).tail(n - k).cwiseAbs().maxCoeff(&pivot);
    pivot += k;
    if (A(pivot, k) == 0) return 0;
    if (pivot != k) {
      A.row(pivot).swap(A.row(k));
      product = -product;
    }
    product *= A(k, k);
    for (Index j = k + 1; j < n; ++j) {
      const double factor = A(k, j) / A(k, k);
      A.col(j).tail(n - k - 1) -= factor * A.col(k).tail(n - k - 1);
    }
  }
  return product;
}

std::optional<double> volume(const Zonotope& Z, Index max_subsets) {
  const auto found = volume_with_error(Z, max_subsets);
  return found ? std::optional(found->value) : std::nullopt;
}

/// An elimination is off by some units in the last place of the product of its columns' lengths
/// (Hadamard), where each row is scaled by its width.
std::optional<ZonotopeVolume> volume_with_error(const Zonotope& Z, Index max_subsets) {
  check(Z, "volume of a zonotope");
  const Index n = Z.dim(), g = Z.generators();
  if (n == 0) return ZonotopeVolume{1, 1, 1};
  if (g < n) return ZonotopeVolume{};
  if (subset_count(g, n, max_subsets) > max_subsets) return std::nullopt;
  const Vector width = Z.G.cwiseAbs().rowwise().sum();
  if (width.minCoeff() == 0) return ZonotopeVolume{};
  const Vector lengths = (width.cwiseInverse().asDiagonal() * Z.G).colwise().norm();
  const double unit = static_cast<double>(8 * n * n) * std::numeric_limits<double>::epsilon();
  double sum = 0, terms = 0;
  Matrix minor(n, n);
  for_each_subset(g, n, [&](const RecycledVector<Index>& columns) {
    double product = 1;
    for (Index k = 0; k < n; ++k) {
      const Index column = columns[static_cast<std::size_t>(k)];
      minor.col(k) = Z.G.col(column);
      product *= lengths[column];
    }
    sum += std::abs(determinant(minor));
    terms += product;
  });
  const double error = unit * terms * width.prod();
  const auto scaled = [&](double x) { return std::ldexp(x, static_cast<int>(n)); };
  return ZonotopeVolume{scaled(sum), scaled(std::max(0.0, sum - error)), scaled(sum + error)};
}

double volume_bound(const Zonotope& Z) {
  const Box hull = interval_hull(Z);
  double bound = (hull.upper - hull.lower).prod();
  for (const GeneratorReduction method :
       {GeneratorReduction::pca, GeneratorReduction::yang_scott}) {
    Matrix T = reduce_generators(Z.G, Z.dim(), method);
    if (T.cols() == Z.dim())
      bound = std::min(bound, std::ldexp(std::abs(determinant(T)), static_cast<int>(Z.dim())));
  }
  return bound;
}

}  // namespace cordon::sets
