// SPDX-License-Identifier: GPL-3.0-or-later
#include "strip_gain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/recycled.hpp"
#include "cordon/sets/generator_reduction.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "determinant.hpp"
#include "row_scales.hpp"
#include "subsets.hpp"

namespace cordon::sets {

namespace {

constexpr Index max_normals = 20000;
/// A part ρᵀx that is a smaller fraction of |ρ|ᵀ|x| gives no gain: it would magnify rounding
/// errors.
constexpr double smallest_part = 1e-6;
/// A strip whose share of what Z meets is no larger counts as a hyperplane.
constexpr double hyperplane = 1e-10;

/// ρᵀx, or 0 where too much of it has cancelled. This is decided in the coordinates of the set: in
/// any other basis the terms that cancelled are no longer seen.
double part_of(VectorIn x, VectorIn rho) {
  const double part = rho.dot(x);
  return std::abs(part) <= smallest_part * rho.cwiseAbs().dot(x.cwiseAbs()) ? 0.0 : part;
}

/// λ of the smallest F-radius; 0 if the strip does not see the generators.
Vector segment_gain(MatrixIn G, VectorIn rho, double sigma) {
  Vector p = linalg::transposed_product(G, rho);
  const double scale = std::max(p.size() ? p.lpNorm<Eigen::Infinity>() : 0.0, sigma);
  const double seen =
      p.size() ? linalg::product(G.cwiseAbs().transpose(), rho.cwiseAbs()).maxCoeff() : 0.0;
  if (p.size() == 0 || p.lpNorm<Eigen::Infinity>() <= smallest_part * seen)
    return Vector::Zero(rho.size());
  p /= scale;
  const double denominator = p.squaredNorm() + (sigma / scale) * (sigma / scale);
  return linalg::product(G, p) / (denominator * scale);
}

/// λ of the smallest F-radius for a box around the generators along their principal axes, rows
/// scaled by the widths.
Vector box_gain(MatrixIn G, VectorIn rho, double sigma) {
  const Index n = G.rows();
  if (G.cols() <= n) return segment_gain(G, rho, sigma);
  Vector widths = G.cwiseAbs().rowwise().sum();
  // the inverse of a subnormal width is infinite
  for (double& width : widths) width = width >= std::numeric_limits<double>::min() ? width : 1;
  const Matrix box =
      reduce_generators(widths.cwiseInverse().asDiagonal() * G, n, GeneratorReduction::pca);
  return segment_gain(widths.asDiagonal() * box, rho, sigma);
}

/// The λ that makes every edge of the interval hull smallest: λ_i minimises Σ_j |G_ij - λ_i p_j| +
/// σ |λ_i|, p_j = ρᵀg_j, and is a median of 0 with weight σ and the G_ij / p_j with weights |p_j|;
/// of several the one next to 0. A hyperplane is left to the F-radius: its Z(λ) lies in it.
Vector hull_gain(MatrixIn G, VectorIn rho, double sigma) {
  struct Break {
    double place, weight;
  };
  Vector parts(G.cols()), lambda = Vector::Zero(G.rows());
  for (Index j = 0; j < G.cols(); ++j) parts[j] = part_of(G.col(j), rho);
  const double reach = parts.lpNorm<1>(), all = sigma + reach;
  if (sigma <= hyperplane * reach) return segment_gain(G, rho, sigma);
  RecycledVector<Break> breaks;
  for (Index i = 0; i < G.rows(); ++i) {
    breaks.clear();
    double above = 0, below = 0;  // weights on either side of 0
    for (Index j = 0; j < G.cols(); ++j) {
      if (parts[j] == 0 || G(i, j) == 0) continue;
      breaks.push_back({G(i, j) / parts[j], std::abs(parts[j])});
      (breaks.back().place > 0 ? above : below) += breaks.back().weight;
    }
    const double side = above > below ? 1 : -1;
    double beyond = std::max(above, below);
    std::sort(breaks.begin(), breaks.end(),
              [&](Break a, Break b) { return side * a.place < side * b.place; });
    for (const Break& next : breaks) {
      if (2 * beyond <= all) break;
      if (side * next.place < 0) continue;
      lambda[i] = next.place;
      beyond -= next.weight;
    }
  }
  return lambda;
}

/// Columns w_J, one for each (n-1)-subset J of the generators, with w_Jᵀλ = det [G_J λ]. Then the
/// volume of Z(λ) is 2ⁿ (|1 - ρᵀλ| V + σ N(λ)) with N(λ) = Σ_J |w_Jᵀλ| and V = Σ |det G_K| over the
/// n-subsets. Along each ray of λ that is piecewise linear with breaks at λ = 0 and ρᵀλ = 1, so
/// that the best λ is 0 or minimises N subject to ρᵀλ = 1.
Matrix normals(const Matrix& G) {
  const Index n = G.rows(), g = G.cols();
  Matrix W(n, subset_count(g, n - 1, max_normals));
  Matrix minor(n - 1, n - 1);
  Index column = 0;
  for_each_subset(g, n - 1, [&](const RecycledVector<Index>& J) {
    for (Index i = 0; i < n; ++i) {
      for (Index k = 0; k < n - 1; ++k) {
        const Index j = J[static_cast<std::size_t>(k)];
        for (Index row = 0; row < n - 1; ++row) minor(row, k) = G(row < i ? row : row + 1, j);
      }
      W(i, column) = ((i + n - 1) % 2 == 0 ? 1.0 : -1.0) * determinant(minor);
    }
    ++column;
  });
  return W;
}

double sum_of_determinants(const Matrix& W, VectorIn lambda) {
  return linalg::transposed_product(W, lambda).lpNorm<1>();
}

/// The direction of min{N(λ) : ρᵀλ = 1}, from its dual max{y : Σ_J w_J ξ_J = y ρ, |ξ_J| ≤ 1}: λ is
/// the multiplier of the rows. No y exceeds `most`, the N of a λ that is known. The solver's answer
/// is a proposal.
Vector proposed_by_linear_program(const Matrix& W, VectorIn rho, double most) {
  const Index n = W.rows(), k = W.cols();
  Matrix A(n, k + 1);
  A << W / most, -rho;
  return BoxedProgram(std::move(A), Vector::Zero(n)).maximum(Vector::Unit(k + 1, k)).y;
}

/// The search for λ in the range of G, where volumes count: rows are scaled alike (ratios of
/// volumes do not change). What ρ sees of a direction is taken from the coordinates of the set.
class VolumeGain {
 public:
  VolumeGain(MatrixIn G, VectorIn rho, double sigma)
      : G_(G), rho_(rho), sigma_(sigma), scale_(row_scales(G)) {
    const Matrix scaled = scale_.asDiagonal() * G;
    Q_ = linalg::range_basis(scaled);
    inner_ = is_full() ? scaled : linalg::transposed_product(Q_, scaled);
    parts_.resize(G.cols());
    for (Index j = 0; j < G.cols(); ++j) parts_[j] = part_of(outside(inner_.col(j)), rho);
  }

  Vector best(StripMethod method) const {
    if (parts_.isZero(0) || Q_.cols() == 0) return unchanged();
    const bool countable =
        subset_count(inner_.cols(), inner_.rows() - 1, max_normals) <= max_normals;
    return countable ? by_volume(method == StripMethod::volume) : by_squared_volume();
  }

 private:
  bool is_full() const { return Q_.cols() == G_.rows(); }
  Vector unchanged() const { return Vector::Zero(rho_.size()); }
  Vector along(Index generator) const { return outside(inner_.col(generator)) / parts_[generator]; }
  /// From the range to the set's coordinates.
  Vector outside(const Vector& direction) const {
    return (is_full() ? direction : Vector(linalg::product(Q_, direction))).cwiseQuotient(scale_);
  }

  Vector by_volume(bool all_directions) const {
    const Matrix W = normals(inner_);
    const Index n = inner_.rows();
    Index chosen = -1;
    double best = infinity, whole = 0;
    for (Index j = 0; j < inner_.cols(); ++j) {
      const double value = sum_of_determinants(W, inner_.col(j));
      whole += value / static_cast<double>(n);  // each n-subset is met once for each of its columns
      if (parts_[j] == 0 || value / std::abs(parts_[j]) >= best) continue;
      best = value / std::abs(parts_[j]);
      chosen = j;
    }
    Vector lambda = chosen < 0 ? unchanged() : along(chosen);
    if (all_directions && n > 2 && chosen >= 0 && best > 0)
      improve(W, best, lambda);  // in one and two dimensions the best λ is parallel to a generator
    return sigma_ * best < whole ? lambda : unchanged();
  }

  void improve(const Matrix& W, double& best, Vector& lambda) const {
    const Vector inner_rho = rho_.cwiseQuotient(scale_);
    const Vector y = proposed_by_linear_program(
        W, is_full() ? inner_rho : Vector(linalg::transposed_product(Q_, inner_rho)), best);
    const Vector direction = outside(y);
    const double part = part_of(direction, rho_);
    if (part == 0 || !direction.allFinite()) return;
    const double value = sum_of_determinants(W, y) / std::abs(part);
    if (value >= best) return;
    best = value;
    lambda = direction / part;
  }

  /// The sum of squared determinants, det(HHᵀ), H the generators of Z(λ): for λ = 0 it is det(GGᵀ),
  /// for λ = g_j/ρᵀg_j that times σ² g_jᵀ(GGᵀ)⁻¹g_j / (ρᵀg_j)², of which the middle is the squared
  /// length of row j of a basis of G's row space.
  Vector by_squared_volume() const {
    const Matrix basis = linalg::range_basis(inner_.transpose());
    Index chosen = -1;
    double best = infinity;
    for (Index j = 0; j < inner_.cols(); ++j) {
      if (parts_[j] == 0) continue;
      const double value = basis.row(j).norm() / std::abs(parts_[j]);
      if (value >= best) continue;
      best = value;
      chosen = j;
    }
    return chosen < 0 || sigma_ * best >= 1 ? unchanged() : along(chosen);
  }

  MatrixIn G_;
  VectorIn rho_;
  double sigma_;
  Vector scale_;
  Matrix Q_, inner_;
  Vector parts_;
};

}  // namespace

Vector strip_gain(MatrixIn G, VectorIn rho, double sigma, StripMethod method) {
  switch (method) {
    case StripMethod::box:
      return box_gain(G, rho, sigma);
    case StripMethod::segment:
      return segment_gain(G, rho, sigma);
    case StripMethod::hull:
      return hull_gain(G, rho, sigma);
    case StripMethod::bravo:
    case StripMethod::volume:
      return VolumeGain(G, rho, sigma).best(method);
  }
  throw Error(Errc::invalid, "strip intersection: unknown method");
}

}  // namespace cordon::sets
