// SPDX-License-Identifier: GPL-3.0-or-later
#include "eigenvalue_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "operations.hpp"

namespace cordon::formulas {

namespace {

/// A matrix of numbers: its entries are points.
using Vertex = SmallSymmetric;

/// Are all pivots of M - shift I proven to be above zero? Then it is positive definite.
bool exceeds(Vertex rest, double shift) {
  const auto n = static_cast<std::size_t>(rest.size);
  auto& m = rest.entries;
  for (std::size_t i = 0; i < n; ++i) m[i][i] = m[i][i] - point(shift);
  for (std::size_t k = 0; k < n; ++k) {
    const Interval pivot = m[k][k];
    if (!(pivot.lower > 0) || !pivot.is_finite()) return false;
    for (std::size_t i = k + 1; i < n; ++i)
      for (std::size_t j = k + 1; j < n; ++j) m[i][j] = m[i][j] - m[i][k] * m[k][j] / pivot;
  }
  return true;
}

/// Found by halving to this share of the matrix's size.
constexpr double precision = 1e-10;
constexpr int most_eigenvalue_halvings = 60;  // of subnormal sizes the share is 0

double least_of_vertex(const Vertex& matrix) {
  const auto n = static_cast<std::size_t>(matrix.size);
  double size = 0, above = infinity;
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) sum += matrix.entries[i][j].magnitude();
    size = std::max(size, sum);
    above = std::min(above, matrix.entries[i][i].lower);  // the least eigenvalue is not above
  }
  if (!std::isfinite(size)) return -infinity;
  double below = -size * (1 + 1e-14);  // none exceeds the sums of rows, which are rounded here
  for (int i = 0; i < most_eigenvalue_halvings && above - below > precision * size; ++i) {
    const double middle = 0.5 * below + 0.5 * above;
    (exceeds(matrix, middle) ? below : above) = middle;
  }
  return below;
}

}  // namespace

double least_eigenvalue(const SmallSymmetric& matrix) {
  const int n = matrix.size;
  double least = infinity;
  for (int signs = 0; signs < (1 << std::max(0, n - 1)); ++signs) {
    Vertex vertex{n, {}};
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const Interval entry = matrix.entries[as_size(i)][as_size(j)];
        const bool equal = ((signs >> i) & 1) == ((signs >> j) & 1);
        vertex.entries[as_size(i)][as_size(j)] = point(equal ? entry.lower : entry.upper);
      }
    }
    least = std::min(least, least_of_vertex(vertex));
  }
  return least;
}

}  // namespace cordon::formulas
