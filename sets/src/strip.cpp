// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/strip.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/lp.hpp"
#include "determinant.hpp"
#include "require.hpp"
#include "row_scales.hpp"
#include "strip_gain.hpp"
#include "subsets.hpp"

namespace cordon::sets {

namespace {

constexpr Index max_normals = 20000;
/// Generators whose part along ρ is a smaller fraction of |ρ|ᵀ|g| give no gain: it would magnify rounding errors.
constexpr double smallest_part = 1e-6;
/// Accumulated rounding errors of a nominal set, relative to its size: less is no proof of emptiness.
constexpr double nominal_error = 1e-10;

/// λ of the smallest F-radius; 0 if the strip does not see the generators.
Vector segment_gain(MatrixIn G, VectorIn rho, double sigma) {
  Vector p = linalg::transposed_product(G, rho);
  const double scale = std::max(p.size() ? p.lpNorm<Eigen::Infinity>() : 0.0, sigma);
  const double seen = p.size() ? linalg::product(G.cwiseAbs().transpose(), rho.cwiseAbs()).maxCoeff() : 0.0;
  if (p.size() == 0 || p.lpNorm<Eigen::Infinity>() <= smallest_part * seen) return Vector::Zero(rho.size());
  p /= scale;
  const double denominator = p.squaredNorm() + (sigma / scale) * (sigma / scale);
  return linalg::product(G, p) / (denominator * scale);
}

/// Columns w_J, one for each (n-1)-subset J of the generators, with w_Jᵀλ = det [G_J λ]. Then the volume of Z(λ) is
/// 2ⁿ (|1 - ρᵀλ| V + σ N(λ)) with N(λ) = Σ_J |w_Jᵀλ| and V = Σ |det G_K| over the n-subsets. Along each ray of λ that is
/// piecewise linear with breaks at λ = 0 and ρᵀλ = 1, so that the best λ is 0 or minimises N subject to ρᵀλ = 1.
Matrix normals(const Matrix& G) {
  const Index n = G.rows(), g = G.cols();
  Matrix W(n, subset_count(g, n - 1, max_normals));
  Matrix minor(n - 1, n - 1);
  Index column = 0;
  for_each_subset(g, n - 1, [&](const std::vector<Index>& J) {
    for (Index i = 0; i < n; ++i) {
      for (Index k = 0; k < n - 1; ++k) {
        const Index j = J[static_cast<std::size_t>(k)];
        minor.col(k).head(i) = G.col(j).head(i);
        minor.col(k).tail(n - 1 - i) = G.col(j).tail(n - 1 - i);
      }
      W(i, column) = ((i + n - 1) % 2 == 0 ? 1.0 : -1.0) * determinant(minor);
    }
    ++column;
  });
  return W;
}

double sum_of_determinants(const Matrix& W, VectorIn lambda) { return linalg::transposed_product(W, lambda).lpNorm<1>(); }

/// min{N(λ) : ρᵀλ = 1} by its dual, max{y : Σ_J w_J ξ_J = y ρ, |ξ_J| ≤ 1}: λ is the multiplier of the rows. Any answer of the
/// solver gives an enclosure; it is used if it is better than `best`.
void improve_by_linear_program(const Matrix& W, VectorIn rho, double& best, Vector& lambda) {
  const Index n = W.rows(), k = W.cols();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double scale = W.lpNorm<Eigen::Infinity>();
  if (!(scale > 0)) return;
  Matrix A(n, k + 1);
  A << W / scale, -rho;
  Vector upper = Vector::Ones(k + 1);
  upper[k] = infinity;
  LinearProgram program(A, Vector::Zero(n), -upper, upper);
  const LinearProgram::Solution solution = program.maximize(Vector::Unit(k + 1, k));
  if (solution.status != LinearProgram::Status::optimal || !solution.y.allFinite()) return;
  const double part = rho.dot(solution.y);
  if (!(std::abs(part) > smallest_part * rho.norm() * solution.y.norm())) return;
  const Vector candidate = solution.y / part;
  const double value = sum_of_determinants(W, candidate);
  if (value < best) {
    best = value;
    lambda = candidate;
  }
}

/// Beyond the limit of subsets: the sum of squared determinants det(HHᵀ), H the generators of Z(λ). For λ = g_j/ρᵀg_j it is
/// det(P) σ² λᵀP⁻¹λ with P = GGᵀ; for λ = 0 it is det(P).
Vector squared_gain(const Matrix& G, VectorIn rho, double sigma, const Vector& parts) {
  const std::optional<Matrix> X = linalg::solve_spd(linalg::product(G, G.transpose()), G);
  if (!X) return segment_gain(G, rho, sigma);
  Index best = -1;
  double best_value = std::numeric_limits<double>::infinity();
  for (Index j = 0; j < G.cols(); ++j) {
    if (parts[j] == 0) continue;
    const double value = G.col(j).dot(X->col(j)) / (parts[j] * parts[j]);
    if (value < best_value) {
      best_value = value;
      best = j;
    }
  }
  if (best < 0 || sigma * sigma * best_value >= 1) return Vector::Zero(rho.size());
  return G.col(best) / parts[best];
}

/// λ of the smallest volume for G of full row rank.
Vector volume_gain(const Matrix& G, VectorIn rho, double sigma, StripMethod method) {
  const Index n = G.rows(), g = G.cols();
  Vector parts = linalg::transposed_product(G, rho);
  for (Index j = 0; j < g; ++j) {
    if (std::abs(parts[j]) <= smallest_part * rho.cwiseAbs().dot(G.col(j).cwiseAbs())) parts[j] = 0;
  }
  if (subset_count(g, n - 1, max_normals) > max_normals) {
    return method == StripMethod::volume ? segment_gain(G, rho, sigma) : squared_gain(G, rho, sigma, parts);
  }
  const Matrix W = normals(G);
  Vector lambda = Vector::Zero(n);
  double best = std::numeric_limits<double>::infinity(), whole = 0;
  for (Index j = 0; j < g; ++j) {
    const double value = sum_of_determinants(W, G.col(j));
    whole += value / static_cast<double>(n);  // each n-subset is met once for each of its columns
    if (parts[j] != 0 && value / std::abs(parts[j]) < best) {
      best = value / std::abs(parts[j]);
      lambda = G.col(j) / parts[j];
    }
  }
  // in one and two dimensions the best λ is parallel to a generator
  if (method == StripMethod::volume && n > 2) improve_by_linear_program(W, rho, best, lambda);
  return sigma * best < whole ? lambda : Vector::Zero(n);
}

/// λ of the smallest volume for any G: rows are scaled alike (volume ratios do not change), then all happens in the range.
Vector volume_gain_in_range(const Matrix& G, VectorIn rho, double sigma, StripMethod method) {
  const Vector scale = row_scales(G);
  const Matrix scaled = scale.asDiagonal() * G;
  const Vector scaled_rho = rho.cwiseQuotient(scale);
  const Matrix Q = linalg::range_basis(scaled);
  if (Q.cols() == 0) return Vector::Zero(rho.size());
  const Vector lambda = Q.cols() == G.rows()
                            ? volume_gain(scaled, scaled_rho, sigma, method)
                            : Vector(linalg::product(Q, volume_gain(linalg::transposed_product(Q, scaled),
                                                                    linalg::transposed_product(Q, scaled_rho), sigma, method)));
  return lambda.cwiseQuotient(scale);
}

/// aᵀb with its rounding error; exactly 0 if every term is.
rounding::Range dot(VectorIn a, VectorIn b) {
  return (a.array() * b.array() != 0).any() ? rounding::dot(a, b) : rounding::Range{0, 0};
}

/// Z(λ); the generators that vanish up to rounding (those parallel to λ, where ρᵀλ = 1) are dropped.
Zonotope member_of_family(const Zonotope& Z, VectorIn rho, double shift, double sigma, const Vector& lambda) {
  Matrix G(Z.dim(), Z.generators() + 1);
  for (Index j = 0; j < Z.generators(); ++j) {
    const auto g = Z.G.col(j);
    G.col(j) = g - lambda * rho.dot(g);
    const double level = 16 * rounding::unit * rho.cwiseAbs().dot(g.cwiseAbs());
    if ((G.col(j).array().abs() <= lambda.array().abs() * level).all()) G.col(j).setZero();
  }
  G.rightCols(1) = sigma * lambda;
  return drop_zero_generators({Z.c + lambda * shift, std::move(G)});
}

/// `terms`: the size of what d was computed from.
std::optional<Zonotope> intersect(const Zonotope& Z, VectorIn rho, double d, double sigma, double terms, StripMethod method) {
  constexpr const char* name = "strip intersection";
  check(Z, name);
  require_size(rho.size(), Z.dim(), name, "the normal");
  require_finite(rho, name, "the normal");
  require_finite(d, name, "the offset");
  require_finite(sigma, name, "the half width");
  if (sigma < 0) throw Error(Errc::invalid, "strip intersection: the half width is negative; it must be at least 0");

  const rounding::Range middle = dot(rho, Z.c);
  const double spread = Z.generators() == 0 ? 0.0 : rounding::residual_norm_1(Vector::Zero(Z.generators()), Z.G, rho);
  const double lowest = rounding::down(middle.lower - spread), highest = rounding::up(middle.upper + spread);
  const double lower = rounding::down(d - sigma), upper = rounding::up(d + sigma);
  const double margin = nominal_error * (terms + rho.cwiseAbs().dot(Z.c.cwiseAbs()) + spread);
  if (lowest - upper > margin || lower - highest > margin) return std::nullopt;
  if (lower <= lowest && highest <= upper) return Z;
  // The strip is narrowed to what Z meets of it: the same intersection, a better enclosure.
  if (lowest > lower || highest < upper) {
    const double low = std::max(lower, lowest), high = std::min(upper, highest);
    d = low / 2 + high / 2;
    sigma = rounding::up(std::abs(high / 2 - low / 2));
  }
  // d - ρᵀc cancels where Z is far from 0; what is lost there widens the strip.
  const rounding::Range difference =
      middle.lower == middle.upper ? rounding::Range{d - middle.lower, d - middle.lower} : rounding::subtract({d, d}, middle);
  const double shift = difference.lower / 2 + difference.upper / 2;
  sigma += difference.upper / 2 - difference.lower / 2;
  const Vector lambda = strip_gain(Z.G, rho, sigma, method);
  if (lambda.isZero(0) || !lambda.allFinite()) return Z;
  return member_of_family(Z, rho, shift, sigma, lambda);
}

}  // namespace

Vector strip_gain(MatrixIn G, VectorIn rho, double sigma, StripMethod method) {
  return method == StripMethod::segment ? segment_gain(G, rho, sigma) : volume_gain_in_range(G, rho, sigma, method);
}

std::optional<Zonotope> intersect_strip(const Zonotope& Z, VectorIn rho, double d, double sigma, StripMethod method) {
  return intersect(Z, rho, d, sigma, std::abs(d), method);
}

std::optional<Zonotope> correct(const Zonotope& Z, MatrixIn C, VectorIn z, MatrixIn T, const Zonotope& V, StripMethod method) {
  constexpr const char* name = "correction of a zonotope";
  check(Z, name);
  check(V, name);
  require_map(C, Z.dim(), name, "C");
  require_map(T, V.dim(), name, "T");
  require_size(z.size(), C.rows(), name, "z");
  require_size(T.rows(), C.rows(), name, "the number of rows of T");
  require_finite(z, name, "z");
  std::optional<Zonotope> result = Z;
  for (Index i = 0; i < C.rows() && result; ++i) {
    const Vector row = T.row(i);
    double d = z[i], sigma = 0;
    if (V.generators() > 0 && !row.isZero(0)) sigma = rounding::residual_norm_1(Vector::Zero(V.generators()), V.G, row);
    if (const rounding::Range middle = dot(row, V.c); middle.lower < middle.upper) {
      const rounding::Range offset = rounding::subtract({z[i], z[i]}, middle);
      d = offset.lower / 2 + offset.upper / 2;
      sigma = rounding::up(sigma + rounding::up(std::max(offset.upper - d, d - offset.lower)));
    }
    const double terms = std::abs(z[i]) + row.cwiseAbs().dot(V.c.cwiseAbs()) + sigma;
    result = intersect(*result, C.row(i).transpose(), d, sigma, terms, method);
  }
  return result;
}

}  // namespace cordon::sets
