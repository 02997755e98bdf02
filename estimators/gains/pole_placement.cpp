// SPDX-License-Identifier: GPL-3.0-or-later
#include "gains/pole_placement.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/linalg.hpp"

namespace cordon::estimators {

namespace {

constexpr int sweeps = 30;
constexpr double dependent = 1e-12;  // σ_n / σ_1 of eigenvectors
constexpr double perpendicular = 1e-6;

/// A real pole or a pair a ± ib, with columns X_b and the block F_b of Aᵀ X - X F: a, or [a b; -b
/// a] for X_b = [Re x, Im x].
struct Block {
  Index at = 0, size = 1;
  Matrix F;
  Matrix space;  ///< orthonormal basis of the vectors X_b (column by column) with U₁ᵀ (Aᵀ X_b - X_b
                 ///< F_b) = 0
};

std::vector<Block> blocks_of(const Matrix& A, const Matrix& C,
                             const std::vector<std::complex<double>>& poles) {
  const Index n = A.rows();
  const Matrix free = linalg::null_space(C);
  const Matrix rows = linalg::transposed_product(free, A.transpose());
  std::vector<Block> blocks;
  Index at = 0;
  for (const std::complex<double>& pole : poles) {
    if (pole.imag() < 0) continue;  // comes with its conjugate
    Block block;
    block.at = at;
    block.size = pole.imag() == 0 ? 1 : 2;
    const double a = pole.real(), b = pole.imag();
    block.F = block.size == 1 ? Matrix{{a}} : Matrix{{a, b}, {-b, a}};
    Matrix conditions(block.size * free.cols(), block.size * n);
    for (Index column = 0; column < block.size;
         ++column) {  // U₁ᵀ (Aᵀ X_b)_column - Σ_i F(i, column) U₁ᵀ X_b,i
      for (Index i = 0; i < block.size; ++i) {
        conditions.block(column * free.cols(), i * n, free.cols(), n) =
            (i == column ? rows : Matrix(Matrix::Zero(free.cols(), n))) -
            block.F(i, column) * free.transpose();
      }
    }
    block.space = linalg::null_space(conditions);
    at += block.size;
    blocks.push_back(std::move(block));
  }
  return blocks;
}

/// σ_n / σ_1.
double independence(const Matrix& X) {
  const Vector sigma = linalg::svd(X).sigma;
  return sigma[0] > 0 ? sigma[sigma.size() - 1] / sigma[0] : 0.0;
}

/// Puts the vector into the columns of the block, at the length √size.
void put(Matrix& X, const Block& block, const Vector& x) {
  X.middleCols(block.at, block.size) =
      x.reshaped(X.rows(), block.size) * (std::sqrt(static_cast<double>(block.size)) / x.norm());
}

/// Moves the columns of the block towards the complement of all others, as far as its space allows.
void turn(Matrix& X, const Block& block) {
  const Index n = X.rows(), after = n - block.at - block.size;
  Matrix others(n, n - block.size);
  others << X.leftCols(block.at), X.rightCols(after);
  const Matrix complement = linalg::null_space(others.transpose());
  const linalg::Svd polar =
      linalg::svd(linalg::transposed_product(complement, X.middleCols(block.at, block.size)));
  const Matrix target = linalg::product(
      complement, linalg::product(polar.U.leftCols(block.size), polar.V.transpose()));
  const Vector x =
      linalg::product(block.space, linalg::transposed_product(block.space, target.reshaped()));
  if (x.norm() > perpendicular) put(X, block, x);
}

/// The eigenvectors: the most independent ones that were met.
Matrix eigenvectors(Index n, const std::vector<Block>& blocks) {
  Matrix X(n, n);
  for (const Block& block : blocks) {
    Vector mix(block.space.cols());
    for (Index i = 0; i < mix.size(); ++i)
      mix[i] = std::cos(static_cast<double>(1 + 3 * i + 7 * block.at));
    put(X, block, linalg::product(block.space, mix));
  }
  Matrix best = X;
  double most = independence(X);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (const Block& block : blocks) {
      if (block.space.cols() > block.size) turn(X, block);  // else it has no choice
    }
    if (const double now = independence(X); now > most) {
      most = now;
      best = X;
    }
  }
  return best;
}

/// L with Aᵀ - Cᵀ Lᵀ = X F X⁻¹.
std::optional<Matrix> gain(const Matrix& A, const Matrix& C,
                           const std::vector<std::complex<double>>& poles) {
  const Index n = A.rows();
  const std::vector<Block> blocks = blocks_of(A, C, poles);
  const Matrix X = eigenvectors(n, blocks);
  if (!(independence(X) > dependent)) return std::nullopt;
  Matrix F = Matrix::Zero(n, n);
  for (const Block& block : blocks) F.block(block.at, block.at, block.size, block.size) = block.F;
  const std::optional<Matrix> closed =
      linalg::solve(X.transpose(), linalg::product(X, F).transpose());  // (X F X⁻¹)ᵀ
  if (!closed) return std::nullopt;
  return linalg::product(A - *closed, linalg::pseudo_inverse(C));
}

/// Each pole takes the nearest eigenvalue that is left.
double placement_error(const Matrix& closed, const std::vector<std::complex<double>>& poles) {
  const Eigen::VectorXcd values = linalg::eigenvalues(closed);
  std::vector<std::complex<double>> left(values.begin(), values.end());
  double error = 0;
  for (const std::complex<double>& pole : poles) {
    const auto nearest = std::min_element(left.begin(), left.end(), [&](auto a, auto b) {
      return std::abs(a - pole) < std::abs(b - pole);
    });
    error = std::max(error, std::abs(*nearest - pole));
    left.erase(nearest);
  }
  return error;
}

}  // namespace

std::optional<PlacedPoles> placed_poles(const Matrix& A, const Matrix& C,
                                        const std::vector<std::complex<double>>& poles) {
  const std::optional<Matrix> L = gain(A, C, poles);
  if (!L || !L->allFinite()) return std::nullopt;
  return PlacedPoles{*L, placement_error(A - linalg::product(*L, C), poles)};
}

}  // namespace cordon::estimators
