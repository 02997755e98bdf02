// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/invariant/schur.hpp"
#include "raised.hpp"

namespace cordon::invariant {

namespace {

using linalg::product;

constexpr int most_squarings = 48;
constexpr double settled = 1e-13;  // what a squaring has to gain, relative to the bound
constexpr int patience =
    8;  // squarings that gain nothing: norms of powers with complex eigenvalues go up and down
constexpr double log_error = 1e-12;  // of logarithms, relative to 1 or to the exponent
constexpr double most_log = 1000;    // 2 to that is still a double
constexpr double enough = 1e-9;      // bounds this near to each other need no powers
constexpr double most_defect = 0.5;  // of I - T⁻¹ T as computed

/// Xᵐ = 2^exponent Y with |Y - value| ≤ error, entries of at most 1.
struct Power {
  Matrix value, error;
  double exponent = 0, m = 1;

  /// Brings the largest entry near to 1; false if nothing is left or something is not finite.
  bool scale() {
    const double size = std::max(value.cwiseAbs().maxCoeff(), error.maxCoeff());
    if (!std::isfinite(size) || size == 0) return false;
    const int shift = std::ilogb(size) + 1;
    // tiny entries may be lost, by less than the smallest double each
    value = value.unaryExpr([&](double x) { return std::ldexp(x, -shift); });
    error = error.unaryExpr([&](double x) { return std::ldexp(x, -shift) + 2 * rounding::tiny; });
    exponent += shift;
    return true;
  }

  Power squared() const {
    const Matrix size = value.cwiseAbs() + error;
    Power next{product(value, value), {}, 2 * exponent, 2 * m};
    next.error = product(error, size) + product(value.cwiseAbs(), error) +
                 rounding::product_error(value, value);
    next.error = (next.error.array() * (1 + 4 * rounding::gamma(2 * value.rows() + 16)) +
                  static_cast<double>(4 * value.rows() + 8) * rounding::tiny)
                     .matrix();
    return next;
  }

  /// An upper bound of ‖Xᵐ‖∞^(1/m).
  double norm_root() const {
    const double norm = raised((value.cwiseAbs() + error).rowwise().sum().maxCoeff(), value.rows());
    return root(norm, 1 + log_error);
  }

  /// A lower bound of (|tr Xᵐ| / n)^(1/m).
  double trace_root() const {
    const Index n = value.rows();
    const double terms = value.diagonal().cwiseAbs().sum(), trace = std::abs(value.trace()),
                 slack = raised(error.trace() + rounding::gamma(n + 2) * terms, n);
    return trace > 2 * slack ? root((trace - slack) / static_cast<double>(n), 1 - log_error) : 0;
  }

  /// The same of X³ᵐ, by that of its square.
  double cubed_trace_root(const Power& square) const {
    const Index n = value.rows();
    const Matrix other = square.value.transpose(), other_error = square.error.transpose();
    const double terms = value.cwiseAbs().cwiseProduct(other.cwiseAbs()).sum(),
                 trace = std::abs(value.cwiseProduct(other).sum());
    const double errors = error.cwiseProduct(other.cwiseAbs() + other_error).sum() +
                          value.cwiseAbs().cwiseProduct(other_error).sum();
    const double slack = raised(
        errors + rounding::gamma(n * n + 2) * terms + static_cast<double>(n * n) * rounding::tiny,
        n * n);
    if (!(trace > 2 * slack)) return 0;
    return Power{{}, {}, exponent + square.exponent, 3 * m}.root(
        (trace - slack) / static_cast<double>(n), 1 - log_error);
  }

  /// (2^exponent x)^(1/m) times a factor for its roundings.
  double root(double x, double factor) const {
    const double log = (std::log2(x) + exponent) / m;
    if (!(std::abs(log) < most_log)) return factor > 1 ? infinity : 0;
    return std::exp2(log) * (1 + (factor - 1) * (1 + std::abs(log)));
  }
};

/// Real eigenvectors T, unit columns: of a conjugate pair the real and the imaginary part, its
/// block being 2×2.
struct RealBasis {
  Matrix T;
  std::vector<Index> sizes;
};

RealBasis real_basis(const Matrix& A) {
  const linalg::ComplexEigen eigen = linalg::complex_eigen(A);
  RealBasis basis{Matrix(A.rows(), A.rows()), {}};
  for (Index k = 0; k < A.rows(); k += basis.sizes.back()) {
    basis.sizes.push_back(eigen.values[k].imag() == 0 ? 1 : 2);
    basis.T.col(k) = eigen.vectors.col(k).real();
    if (basis.sizes.back() == 2) basis.T.col(k + 1) = eigen.vectors.col(k).imag();
  }
  return basis;
}

/// M = T⁻¹ X T for all |X - A| ≤ error, with its error. R ≈ T⁻¹, R T = I - F and M = (I - F)⁻¹ R X
/// T.
std::optional<Power> transformed(const Matrix& A, const Matrix& error, const Matrix& T) {
  const Index n = A.rows();
  const std::optional<Matrix> R = linalg::solve(T, Matrix::Identity(n, n));
  if (!R || !R->allFinite()) return std::nullopt;
  const Matrix F =
      (Matrix::Identity(n, n) - product(*R, T)).cwiseAbs() + rounding::product_error(*R, T);
  const double f = raised(F.rowwise().sum().maxCoeff(), n);
  if (!(f < most_defect)) return std::nullopt;
  const Matrix AT = product(A, T);
  const Matrix off = (rounding::product_error(A, T) + product(error, T.cwiseAbs())) *
                     (1 + 2 * rounding::gamma(n + 8));
  Power M{product(*R, AT), {}};
  M.error = (rounding::product_error(*R, AT) + product(R->cwiseAbs(), off)) *
            (1 + 2 * rounding::gamma(n + 8));
  const Eigen::RowVectorXd largest = (M.value.cwiseAbs() + M.error).colwise().maxCoeff();
  M.error.rowwise() += largest * raised(f / (1 - f), 4);
  M.error *= 1 + 8 * rounding::unit;
  return M;
}

/// Gershgorin's discs for blocks aI + bJ [Feingold1962]: each eigenvalue is within r of a block's
/// pair a ± bi, where r sums the norms of what else is in its rows, and as many of them are in a
/// connected union of discs as blocks' eigenvalues. {0, ∞} where the eigenvectors are no basis.
RadiusBounds by_eigenvectors(const Matrix& A, const Matrix& error) {
  const RealBasis basis = real_basis(A);
  if (!basis.T.allFinite()) return {};
  const std::optional<Power> M = transformed(A, error, basis.T);
  if (!M || !M->error.allFinite()) return {};
  double largest = 0, upper = 0, all = 0;
  Index first = 0;
  for (const Index size : basis.sizes) {
    Matrix row = M->value.middleRows(first, size);
    auto block = row.middleCols(first, size);
    const double a = size == 1 ? block(0, 0) : 0.5 * (block(0, 0) + block(1, 1)),
                 b = size == 1 ? 0 : 0.5 * (block(0, 1) - block(1, 0));
    block -= size == 1 ? Matrix{{a}} : Matrix{{a, b}, {-b, a}};
    // the last digit of the difference, and the blocks' norms by those of their columns
    const double slack = 4 * rounding::unit *
                         M->value.middleRows(first, size).middleCols(first, size).cwiseAbs().sum(),
                 modulus = std::hypot(a, b);
    const double r =
        raised(row.cwiseAbs().sum() + M->error.middleRows(first, size).sum() + slack, 2 * A.rows());
    if (!std::isfinite(r) || !std::isfinite(modulus)) return {};
    largest = std::max(largest, modulus * (1 - 4 * rounding::unit));
    upper = std::max(upper, (modulus + r) * (1 + 8 * rounding::unit));
    all += r;
    first += size;
  }
  // the union around the largest has two discs of each pair, which a path crosses once
  return {std::max(0.0, (largest - 4 * raised(all, A.rows())) * (1 - 8 * rounding::unit)), upper};
}

}  // namespace

RadiusBounds radius_bounds(MatrixIn A, MatrixIn error) {
  if (A.rows() != A.cols()) throw Error(Errc::dimension, "a spectral radius needs a square matrix");
  if (!A.allFinite() || !error.allFinite())
    throw Error(Errc::not_finite, "a spectral radius needs finite entries");
  const Index n = A.rows();
  if (n == 0) return {0, 0};
  if (error.size() != 0 && (error.rows() != n || error.cols() != n)) {
    throw Error(Errc::dimension, "the errors of a matrix have another shape than it");
  }
  Power power{A, error.size() == 0 ? Matrix(Matrix::Zero(n, n)) : Matrix(error)};
  if (power.value.isZero(0) && power.error.isZero(0)) return {0, 0};
  RadiusBounds bounds = by_eigenvectors(power.value, power.error);
  if (bounds.upper <= bounds.lower * (1 + enough)) return bounds;
  int idle = 0;
  for (int k = 0; k <= most_squarings && power.scale(); ++k) {
    const double upper = power.norm_root(), lower = power.trace_root();
    idle =
        upper < bounds.upper * (1 - settled) || lower > bounds.lower * (1 + settled) ? 0 : idle + 1;
    bounds.upper = std::min(bounds.upper, upper);
    bounds.lower = std::max(bounds.lower, lower);
    if (idle >= patience || bounds.upper <= bounds.lower * (1 + 10 * log_error)) break;
    Power square = power.squared();
    if (!square.value.allFinite() || !square.error.allFinite()) break;
    bounds.lower = std::max(bounds.lower, power.cubed_trace_root(square));
    power = std::move(square);
  }
  return bounds;
}

}  // namespace cordon::invariant
