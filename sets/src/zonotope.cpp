// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/zonotope.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "require.hpp"
#include "residue.hpp"

namespace cordon::sets {

namespace {

Matrix beside(MatrixIn left, MatrixIn right) {
  Matrix C(left.rows(), left.cols() + right.cols());
  C << left, right;
  return C;
}

Matrix without_zero_columns(MatrixIn G) {
  Matrix kept(G.rows(), G.cols());
  Index count = 0;
  for (Index j = 0; j < G.cols(); ++j) {
    if ((G.col(j).array() != 0).any()) kept.col(count++) = G.col(j);
  }
  kept.conservativeResize(Eigen::NoChange, count);
  return kept;
}

struct Pair {
  Index left, right;
  double saved;
};

/// Partner in Y of each generator of X (-1: none), greedily by the mean width that a pair saves
/// against two single generators: |a| + |b| - (|a + b| + |a - b|)/2 ≥ 0, at most min(|a|, |b|),
/// which parallel ones reach.
std::vector<Index> partners(MatrixIn A, MatrixIn B) {
  std::vector<Pair> pairs;
  pairs.reserve(static_cast<std::size_t>(A.cols() * B.cols()));
  for (Index i = 0; i < A.cols(); ++i) {
    for (Index j = 0; j < B.cols(); ++j) {
      const double apart = A.col(i).stableNorm() + B.col(j).stableNorm();
      const double paired =
          ((A.col(i) + B.col(j)).stableNorm() + (A.col(i) - B.col(j)).stableNorm()) / 2;
      pairs.push_back({i, j, apart - paired});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.saved > b.saved; });
  std::vector<Index> partner(static_cast<std::size_t>(A.cols()), -1);
  std::vector<bool> taken(static_cast<std::size_t>(B.cols()), false);
  for (const Pair& pair : pairs) {
    if (partner[static_cast<std::size_t>(pair.left)] >= 0 ||
        taken[static_cast<std::size_t>(pair.right)])
      continue;
    partner[static_cast<std::size_t>(pair.left)] = pair.right;
    taken[static_cast<std::size_t>(pair.right)] = true;
  }
  return partner;
}

}  // namespace

void check(const Zonotope& Z, const char* what) {
  require_size(Z.G.rows(), Z.c.size(), what, "the number of rows of the generators");
  require_finite(Z.c, what, "the centre");
  require_finite(Z.G, what, "the generators");
}

Zonotope affine_map(const Zonotope& Z, MatrixIn T, VectorIn t) {
  check(Z, "affine map of a zonotope");
  require_map(T, Z.dim(), "affine map of a zonotope", "the matrix");
  require_size(t.size(), T.rows(), "affine map of a zonotope", "the translation");
  require_finite(t, "affine map of a zonotope", "the translation");
  return {linalg::product(T, Z.c) + t, linalg::product(T, Z.G)};
}

Zonotope minkowski_sum(const Zonotope& X, const Zonotope& Y) {
  check(X, "sum of zonotopes");
  check(Y, "sum of zonotopes");
  require_size(Y.dim(), X.dim(), "sum of zonotopes", "the second zonotope");
  return {X.c + Y.c, beside(X.G, Y.G)};
}

Zonotope affine_sum(const Zonotope& Z, MatrixIn A, VectorIn f,
                    std::span<const MappedZonotope> summands) {
  constexpr const char* name = "sum of mapped zonotopes";
  check(Z, name);
  require_map(A, Z.dim(), name, "the matrix");
  require_size(f.size(), A.rows(), name, "the translation");
  require_finite(f, name, "the translation");
  Index columns = Z.generators();
  for (const MappedZonotope& summand : summands) {
    check(summand.set, name);
    require_map(summand.T, summand.set.dim(), name, "a summand's matrix");
    require_size(summand.T.rows(), A.rows(), name, "the rows of a summand's matrix");
    columns += summand.set.generators();
  }
  Zonotope sum{f, Matrix(A.rows(), columns)};
  Vector terms = f.cwiseAbs(), size;
  Index at = 0;
  const auto add = [&](MatrixIn T, const Zonotope& X) {
    take_reach(X.c, X.G, size);
    for (Index i = 0; i < T.rows(); ++i) {
      double center = 0;
      for (Index k = 0; k < T.cols(); ++k) {
        center += T(i, k) * X.c[k];
        terms[i] += std::abs(T(i, k)) * size[k];
      }
      sum.c[i] += center;
    }
    linalg::product(T, X.G, sum.G.middleCols(at, X.generators()));
    at += X.generators();
  };
  add(A, Z);
  for (const MappedZonotope& summand : summands) add(summand.T, summand.set);
  if (summands.empty()) return sum;
  return with_residue(std::move(sum), terms);
}

Zonotope cartesian_product(const Zonotope& X, const Zonotope& Y) {
  check(X, "product of zonotopes");
  check(Y, "product of zonotopes");
  Vector c(X.dim() + Y.dim());
  c << X.c, Y.c;
  return {std::move(c), linalg::block_diagonal(X.G, Y.G)};
}

Zonotope convex_hull(const Zonotope& X, const Zonotope& Y) {
  check(X, "hull of zonotopes");
  check(Y, "hull of zonotopes");
  require_size(Y.dim(), X.dim(), "hull of zonotopes", "the second zonotope");
  if (X.c == Y.c && X.G.cols() == Y.G.cols() && X.G == Y.G) return X;
  const Matrix A = without_zero_columns(X.G), B = without_zero_columns(Y.G);
  const std::vector<Index> partner = partners(A, B);
  std::vector<bool> taken(static_cast<std::size_t>(B.cols()), false);
  Matrix G(X.dim(), 2 * A.cols() + B.cols() + 1);
  Index count = 0;
  G.col(count++) = X.c / 2 - Y.c / 2;
  for (Index i = 0; i < A.cols(); ++i) {
    const Index j = partner[static_cast<std::size_t>(i)];
    if (j < 0) {
      G.col(count++) = A.col(i);
    } else {
      taken[static_cast<std::size_t>(j)] = true;
      G.col(count++) = (A.col(i) + B.col(j)) / 2;
      G.col(count++) = (A.col(i) - B.col(j)) / 2;
    }
  }
  for (Index j = 0; j < B.cols(); ++j) {
    if (!taken[static_cast<std::size_t>(j)]) G.col(count++) = B.col(j);
  }
  return {X.c / 2 + Y.c / 2, without_zero_columns(G.leftCols(count))};
}

Zonotope interval_map(const Zonotope& Z, const IntervalMatrix& A) {
  constexpr const char* name = "interval map of a zonotope";
  check(Z, name);
  require_map(A.center, Z.dim(), name, "the centre");
  require_map(A.radius, Z.dim(), name, "the radius");
  require_size(A.radius.rows(), A.rows(), name, "the radius");
  if (A.radius.size() > 0 && A.radius.minCoeff() < 0) {
    throw Error(Errc::invalid, std::string(name) + ": a radius is negative; radii are at least 0");
  }
  Vector magnitude = Z.c.cwiseAbs();
  for (Index j = 0; j < Z.generators(); ++j) magnitude += Z.G.col(j).cwiseAbs();
  const Vector spread = linalg::product(A.radius, magnitude);
  return {linalg::product(A.center, Z.c),
          without_zero_columns(
              beside(linalg::product(A.center, Z.G), spread.asDiagonal().toDenseMatrix()))};
}

Box interval_hull(const Zonotope& Z) {
  check(Z, "interval hull of a zonotope");
  const Index n = Z.dim();
  Vector sums = Vector::Zero(n), terms = Vector::Zero(n);  // of the rows: what is not 0
  const double* entry = Z.G.data();
  for (Index j = 0; j < Z.generators(); ++j) {
    for (Index i = 0; i < n; ++i) {
      const double size = std::abs(*entry++);
      sums[i] += size;
      terms[i] += size > 0 ? 1 : 0;
    }
  }
  Box hull{Z.c, Z.c};
  for (Index i = 0; i < n; ++i) {
    if (terms[i] == 0) continue;
    // as rounding::norm_1 of the row; a single term is not rounded
    const double lost =
                     rounding::up(rounding::gamma(2 * static_cast<Index>(terms[i]) + 2) * sums[i]),
                 radius = terms[i] == 1 ? sums[i] : rounding::up(sums[i] + lost);
    hull.lower[i] = rounding::down(Z.c[i] - radius);
    hull.upper[i] = rounding::up(Z.c[i] + radius);
  }
  return hull;
}

double support(const Zonotope& Z, VectorIn d) {
  check(Z, "support of a zonotope");
  require_size(d.size(), Z.dim(), "support of a zonotope", "the direction");
  require_finite(d, "support of a zonotope", "the direction");
  const double spread =
      Z.generators() == 0 ? 0.0 : rounding::residual_norm_1(Vector::Zero(Z.generators()), Z.G, d);
  const double h = rounding::up(rounding::dot(d, Z.c).upper + spread);
  return std::isnan(h) ? infinity : h;
}

double f_radius(const Zonotope& Z) { return Z.G.size() == 0 ? 0.0 : Z.G.stableNorm(); }

Zonotope drop_zero_generators(const Zonotope& Z) {
  check(Z, "zonotope");
  return {Z.c, without_zero_columns(Z.G)};
}

Zonotope merge_parallel_generators(const Zonotope& Z) {
  check(Z, "zonotope");
  constexpr double tolerance = 8 * rounding::unit;
  Matrix directions = without_zero_columns(Z.G), merged = directions;
  Index count = 0;
  for (Index j = 0; j < directions.cols(); ++j) {
    const Vector g = merged.col(j);
    const Vector unit = g / g.stableNorm();
    Index twin = 0;
    double sign = 1;
    for (; twin < count; ++twin) {
      sign = directions.col(twin).dot(unit) < 0 ? -1.0 : 1.0;
      const auto gap = (unit - sign * directions.col(twin)).cwiseAbs().array();
      if ((gap <= tolerance * unit.cwiseAbs().array()).all()) break;
    }
    if (twin < count) {
      merged.col(twin) += sign * g;
    } else {
      directions.col(count) = unit;
      merged.col(count++) = g;
    }
  }
  merged.conservativeResize(Eigen::NoChange, count);
  return {Z.c, std::move(merged)};
}

}  // namespace cordon::sets
