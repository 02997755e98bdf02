// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/invariant/rpi.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/schur.hpp"
#include "cordon/sets/generator_reduction.hpp"
#include "weights.hpp"

namespace cordon::invariant {

namespace {

using linalg::product;
using sets::Zonotope;

constexpr double largest_condition = 1e7;
constexpr double polygon_share = 0.8;      // of 1 - |λ| that is left after the polygon's corners
constexpr double rounding_margin = 1e-13;  // relative, of radii

/// One real eigenvalue (size 1) or a conjugate pair (size 2) with its columns of the real basis.
struct Block {
  Index first, size;
  double modulus;
  Index edges = 0;    // of half the polygon, for a pair
  double corner = 1;  // circumradius over inradius
};

struct PolygonBasis {
  Matrix T;
  std::vector<Block> blocks;
};

/// Generators that keep |λ| / cos(π/2k) so far below 1 that the polygon stays near to the disc.
void choose_polygon(Block& block) {
  const double wanted = block.modulus / (1 - polygon_share * (1 - block.modulus));
  const double angle = std::acos(std::max(wanted, std::cos(std::numbers::pi / 8)));
  block.edges = static_cast<Index>(std::ceil(std::numbers::pi / (2 * angle)));
  block.corner = 1 / std::cos(std::numbers::pi / (2 * static_cast<double>(block.edges)));
}

PolygonBasis polygon_basis(const Matrix& A) {
  const linalg::ComplexEigen eigen = linalg::complex_eigen(A);
  const Index n = A.rows();
  PolygonBasis basis{Matrix(n, n), {}};
  for (Index k = 0; k < n;) {
    Block block{k, eigen.values[k].imag() == 0 ? 1 : 2, std::abs(eigen.values[k])};
    basis.T.col(k) = eigen.vectors.col(k).real();
    if (block.size == 2) {
      basis.T.col(k + 1) = eigen.vectors.col(k).imag();
      choose_polygon(block);
    }
    k += block.size;
    basis.blocks.push_back(block);
  }
  return basis;
}

void require_eigenvectors(const Matrix& T) {
  const Vector sigma = linalg::svd(T).sigma;
  const double smallest = sigma[sigma.size() - 1];
  const double condition = smallest > 0 ? sigma[0] / smallest : infinity;
  if (condition <= largest_condition) return;
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", condition);
  throw Error(
      Errc::invalid,
      std::string("the matrix is defective, or nearly so: the condition of its eigenvectors is ") +
          text +
          ", and the closed form of an invariant set needs a basis of them; use the minimal set");
}

/// r with K r + s ≤ r, where K bounds what N = T⁻¹ A T makes of blocks: moduli on the diagonal,
/// rounding elsewhere.
Vector block_radii(const std::vector<Block>& blocks, const Matrix& N, const Matrix& generators) {
  const Index m = static_cast<Index>(blocks.size());
  Matrix K(m, m);
  Vector s(m);
  for (Index a = 0; a < m; ++a) {
    const Block& row = blocks[static_cast<std::size_t>(a)];
    s[a] = generators.cols() == 0
               ? 0.0
               : generators.middleRows(row.first, row.size).colwise().norm().sum();
    for (Index b = 0; b < m; ++b) {
      const Block& col = blocks[static_cast<std::size_t>(b)];
      Matrix part = N.block(row.first, col.first, row.size, col.size);
      double gain = part.norm();
      if (a == b &&
          row.size == 2) {  // ‖aI + bJ‖₂ = |λ|, and the Frobenius norm of what is not of this form
        const double re = 0.5 * (part(0, 0) + part(1, 1)), im = 0.5 * (part(0, 1) - part(1, 0));
        part -= Matrix{{re, im}, {-im, re}};
        gain = std::hypot(re, im) + part.norm();
      }
      K(a, b) = gain * col.corner;
    }
  }
  const std::optional<Matrix> r = linalg::solve(Matrix::Identity(m, m) - K, s);
  if (r && (r->array() >= 0).all()) {
    const Vector radii = r->col(0) * (1 + rounding_margin);
    if (((product(K, radii) + s).array() <= radii.array() * (1 + rounding_margin)).all())
      return radii;
  }
  throw Error(Errc::invalid,
              "no invariant set in closed form: an eigenvalue is too near to the unit circle for "
              "the rounding errors of "
              "the eigenvectors; use the minimal set");
}

/// Shape of the product of intervals and polygons.
Matrix block_shape(const PolygonBasis& basis, const Vector& radii) {
  Index columns = 0;
  for (const Block& block : basis.blocks) columns += block.size == 1 ? 1 : block.edges;
  Matrix H(basis.T.rows(), columns);
  Index next = 0;
  for (std::size_t k = 0; k < basis.blocks.size(); ++k) {
    const Block& block = basis.blocks[k];
    const double r = radii[static_cast<Index>(k)];
    if (block.size == 1) {
      H.col(next++) = r * basis.T.col(block.first);
      continue;
    }
    const double step = std::numbers::pi / static_cast<double>(block.edges);
    const double length = r * std::tan(step / 2);
    for (Index e = 0; e < block.edges; ++e) {
      const double angle = step * static_cast<double>(e);
      H.col(next++) = length * (std::cos(angle) * basis.T.col(block.first) +
                                std::sin(angle) * basis.T.col(block.first + 1));
    }
  }
  return H;
}

void check_system(MatrixIn A, const Zonotope& D) {
  if (A.rows() != A.cols()) throw Error(Errc::dimension, "an invariant set needs a square matrix");
  if (!A.allFinite()) throw Error(Errc::not_finite, "the matrix has entries that are not finite");
  sets::check(D, "the disturbance");
  if (D.dim() != A.rows())
    throw Error(Errc::dimension, "the disturbance has another dimension than the matrix");
}

}  // namespace

Zonotope rpi_set(MatrixIn A, const Zonotope& D) {
  check_system(A, D);
  require_schur(A, "the matrix");
  const Index n = A.rows();
  if (n == 0) return {D.c, Matrix(0, 0)};
  // units of the states must decide neither what is defective nor what is singular
  Vector scale = decay_weights(A, D.c.cwiseAbs() + D.G.cwiseAbs().rowwise().sum());
  for (double& x : scale) x = std::ldexp(1.0, std::ilogb(x));
  const Vector inverse = scale.cwiseInverse();
  const Matrix scaled = inverse.asDiagonal() * Matrix(A) * scale.asDiagonal();
  const std::optional<Matrix> solution =
      linalg::solve(Matrix::Identity(n, n) - scaled, inverse.cwiseProduct(D.c));
  if (!solution) throw Error(Errc::invalid, "the matrix has an eigenvalue too near to 1");
  const Vector center = scale.cwiseProduct(solution->col(0));
  if (D.G.cols() == 0 || D.G.isZero(0)) return {center, Matrix(n, 0)};
  const PolygonBasis basis = polygon_basis(scaled);
  require_eigenvectors(basis.T);
  const std::optional<Matrix> W = linalg::solve(basis.T, Matrix::Identity(n, n));
  if (!W) throw Error(Errc::internal, "a well-conditioned basis of eigenvectors has no inverse");
  const Matrix N = product(*W, product(scaled, basis.T));
  const Vector radii = block_radii(basis.blocks, N, product(*W, inverse.asDiagonal() * D.G));
  return {center, scale.asDiagonal() * block_shape(basis, radii)};
}

Zonotope iterate(MatrixIn A, const Zonotope& D, const Zonotope& start, Index steps,
                 Index max_columns) {
  check_system(A, D);
  sets::check(start, "the start");
  if (start.dim() != A.rows())
    throw Error(Errc::dimension, "the start has another dimension than the matrix");
  if (steps < 0) throw Error(Errc::invalid, "the number of steps is negative");
  if (max_columns < 0 || (max_columns > 0 && max_columns < A.rows())) {
    throw Error(Errc::invalid, "a reduction to " + std::to_string(max_columns) + " columns in " +
                                   std::to_string(A.rows()) +
                                   " dimensions: it needs one per dimension at least");
  }
  Zonotope X = start;
  for (Index k = 0; k < steps; ++k) {
    Matrix G(X.dim(), X.G.cols() + D.G.cols());
    G << product(A, X.G), D.G;
    X = sets::drop_zero_generators({product(A, X.c) + D.c, std::move(G)});
    if (max_columns > 0)
      X.G = sets::reduce_generators(X.G, max_columns, sets::GeneratorReduction::combastel);
  }
  return X;
}

}  // namespace cordon::invariant
