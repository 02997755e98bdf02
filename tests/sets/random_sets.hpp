// SPDX-License-Identifier: GPL-3.0-or-later
// Arbitrary sets for properties: ordinary, flat, with parallel or zero generators, points, badly
// scaled (1e-8 … 1e8).
#pragma once

#include <cmath>

#include <rapidcheck.h>

#include "cordon/core/box.hpp"
#include "cordon/sets/sampling.hpp"
#include "cordon/sets/zonotope.hpp"

namespace cordon::test {

inline double arbitrary_number() { return *rc::gen::inRange(-1000, 1001) / 100.0; }

inline Matrix arbitrary_matrix(Index rows, Index cols) {
  Matrix A(rows, cols);
  for (double& a : A.reshaped()) a = *rc::gen::inRange(0, 4) == 0 ? 0.0 : arbitrary_number();
  return A;
}

inline Vector arbitrary_vector(Index n) { return arbitrary_matrix(n, 1); }

/// Powers of ten from 1e-8 to 1e8.
inline Vector arbitrary_scales(Index n) {
  Vector s(n);
  for (double& value : s) value = std::pow(10.0, *rc::gen::inRange(-8, 9));
  return s;
}

/// A zonotope of dimension n; `scales` multiply its coordinates.
inline sets::Zonotope arbitrary_zonotope(Index n, const Vector& scales) {
  Matrix G = arbitrary_matrix(n, *rc::gen::inRange<Index>(0, 9));
  switch (*rc::gen::inRange(0, 5)) {
    case 0:  // flat: all generators in a subspace
      if (n > 1) G = arbitrary_matrix(n, n - 1) * arbitrary_matrix(n - 1, G.cols());
      break;
    case 1:  // nearly flat
      if (n > 1)
        G = Matrix(arbitrary_matrix(n, n - 1) * arbitrary_matrix(n - 1, G.cols())) + 1e-9 * G;
      break;
    case 2:  // parallel generators
      for (Index j = 1; j < G.cols(); j += 2) G.col(j) = G.col(j - 1) * arbitrary_number();
      break;
    case 3:  // columns of very different lengths
      G = Matrix(G * arbitrary_scales(G.cols()).asDiagonal());
      break;
    default:
      break;
  }
  return {scales.cwiseProduct(arbitrary_vector(n)), scales.asDiagonal() * G};
}

/// Plain or badly scaled coordinates.
inline Vector arbitrary_coordinates(Index n) {
  return *rc::gen::inRange(0, 3) == 0 ? arbitrary_scales(n) : Vector(Vector::Ones(n));
}

inline Index arbitrary_dim(Index largest = 5) { return *rc::gen::inRange<Index>(1, largest + 1); }
inline sets::Random arbitrary_random() {
  return sets::Random(*rc::gen::arbitrary<std::uint64_t>());
}

/// A point of Z: a vertex of the factor box, a point of one of its faces or an inner one.
inline Vector point_of(const sets::Zonotope& Z, sets::Random& random) {
  Vector xi = random.cube(Z.generators());
  const double vertices = random.unit();
  for (double& x : xi) {
    if (random.unit() < vertices) x = x < 0 ? -1.0 : 1.0;
  }
  return Z.c + Z.G * xi;
}

inline Vector point_of(const Box& X, sets::Random& random) {
  Vector x(X.dim());
  for (Index i = 0; i < X.dim(); ++i) {
    const double lower = std::isfinite(X.lower[i]) ? X.lower[i] : -1e6,
                 upper = std::isfinite(X.upper[i]) ? X.upper[i] : 1e6;
    const double choice = random.unit();
    x[i] = choice < 0.25  ? lower
           : choice < 0.5 ? upper
                          : std::clamp(random.between(lower, upper), lower, upper);
  }
  return x;
}

/// A direction in which coordinates of unlike scale count alike, or a coordinate direction.
inline Vector direction_for(const Vector& scales, sets::Random& random) {
  if (random.unit() < 0.3) {
    const auto i = static_cast<Index>(random.unit() * static_cast<double>(scales.size()));
    return Vector::Unit(scales.size(), i) * (random.unit() < 0.5 ? -1.0 : 1.0);
  }
  return random.cube(scales.size()).cwiseQuotient(scales);
}

/// Coordinate sizes of Z, 1 where it has none.
inline Vector sizes_of(const sets::Zonotope& Z) {
  Vector s = Z.c.cwiseAbs() + Z.G.cwiseAbs().rowwise().sum();
  for (double& value : s) value = value > 0 ? value : 1.0;
  return s;
}

/// dᵀx ≤ h_Z(d) up to `tolerance`, relative to Σ |d_i| sizes_i, in `count` random directions.
/// `sizes` are those of the numbers that took part: a cut of a long set is off by the rounding
/// errors of the long one.
inline bool encloses(const sets::Zonotope& Z, const Vector& x, const Vector& sizes,
                     sets::Random& random, double tolerance = 1e-9, int count = 12) {
  for (int k = 0; k < count; ++k) {
    const Vector d = direction_for(sizes, random);
    if (!(d.dot(x) <=
          d.dot(Z.c) + (Z.G.transpose() * d).lpNorm<1>() + tolerance * d.cwiseAbs().dot(sizes)))
      return false;
  }
  return true;
}

inline bool encloses(const sets::Zonotope& Z, const Vector& x, sets::Random& random) {
  return encloses(Z, x, sizes_of(Z), random);
}

/// h_X(d) ≤ h_Y(d) up to `tolerance` likewise.
inline bool is_inside(const sets::Zonotope& X, const sets::Zonotope& Y, sets::Random& random,
                      double tolerance = 1e-9, int count = 12) {
  const Vector sizes = sizes_of(X).cwiseMax(sizes_of(Y));
  for (int k = 0; k < count; ++k) {
    const Vector d = direction_for(sizes, random);
    const double x = d.dot(X.c) + (X.G.transpose() * d).lpNorm<1>(),
                 y = d.dot(Y.c) + (Y.G.transpose() * d).lpNorm<1>();
    if (!(x <= y + tolerance * d.cwiseAbs().dot(sizes))) return false;
  }
  return true;
}

}  // namespace cordon::test
