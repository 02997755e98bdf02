// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/ellipsoid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "cordon/core/linalg.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/sets/outward.hpp"
#include "cordon/solvers/outward_questions.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "ellipsoid_bounds.hpp"
#include "require.hpp"

namespace cordon::sets {

namespace {

using namespace ellipsoids;

/// The same set with an L of orthogonal columns, at most n. With L = U diag(σ) Vᵀ + E: L u = U
/// diag(σ) (Vᵀu) + E u, where ‖Vᵀu‖ is 1 up to the defect of V and |E u| is taken up by the
/// rounding box.
Ellipsoid with_principal_axes(const Ellipsoid& X) {
  if (X.L.cols() == 0 || X.dim() == 0) return {X.c, Matrix(X.dim(), 0), X.r};
  const linalg::Svd svd = linalg::svd(X.L);
  const Index k = svd.sigma.size();
  const Matrix V = svd.V.leftCols(k), axes = svd.U.leftCols(k) * svd.sigma.asDiagonal();
  const Matrix back = linalg::product(axes, V.transpose()),
               error = rounding::product_error(axes, V.transpose());
  const Matrix gram = linalg::product(V.transpose(), V);
  const double defect =
      (gram - Matrix::Identity(k, k)).norm() + rounding::product_error(V.transpose(), V).norm();
  Ellipsoid result{X.c, axes * (1 + 2 * defect),
                   X.r + row_sums((X.L - back).cwiseAbs() + error + 2 * unit * X.L.cwiseAbs())};
  result.r = (result.r + 4 * unit * row_sums(result.L)) * enlarge;
  result.r.array() += static_cast<double>(k) * rounding::tiny;
  return result;
}

/// Nonzero generators.
Matrix generators(const Zonotope& Z) {
  Matrix G(Z.dim(), Z.generators());
  Index used = 0;
  for (Index j = 0; j < Z.generators(); ++j) {
    if (!Z.G.col(j).isZero(0)) G.col(used++) = Z.G.col(j);
  }
  return G.leftCols(used);
}

/// The ellipsoid cut by all sides of a box that is known to hold the set.
std::optional<Ellipsoid> cut_by(std::optional<Ellipsoid> X, const Box& hull,
                                EllipsoidCriterion criterion) {
  for (Index i = 0; i < hull.dim() && X; ++i)
    X = cut(*X, {Vector::Unit(hull.dim(), i), hull.lower[i], hull.upper[i]}, criterion);
  return X;
}

}  // namespace

Index Ellipsoid::axes() const {
  Index count = 0;
  for (Index j = 0; j < L.cols(); ++j) count += L.col(j).isZero(0) ? 0 : 1;
  return std::min(count, dim());
}

EnclosingEllipsoid enclose(const Zonotope& Z, EllipsoidCriterion criterion) {
  check(Z, "ellipsoid around a zonotope");
  const Index n = Z.dim();
  EllipsoidSum sum(Z.c);
  const Matrix G = generators(Z);
  if (criterion == EllipsoidCriterion::volume && G.cols() > 1 && n > 1) {
    // Σ 1/wᵢ² ≤ 1 for the weights wᵢ = √m
    const double weight = std::sqrt(static_cast<double>(G.cols())) * (1 + 4 * unit);
    const Vector errors = 2 * unit * weight * row_sums(G) +
                          Vector::Constant(n, static_cast<double>(G.cols()) * rounding::tiny);
    sum.add(Matrix::Identity(n, n), Ellipsoid{Vector::Zero(n), G * weight, errors});
    return {sum.enclosed().set, false};
  }
  sum.add(Matrix::Identity(n, n), Zonotope{Vector::Zero(n), G});
  return sum.enclosed();
}

std::optional<EnclosingEllipsoid> enclose(const LineForm& X, EllipsoidCriterion criterion) {
  if (X.constraints() == 0) return enclose(Zonotope{X.c, X.G}, criterion);
  const Box hull = cordon::outward::interval_hull(X);
  if (hull.is_empty()) return std::nullopt;
  const LineForm free = outward::eliminate_constraints(X, 0, {.rescale = true}).set;
  std::optional<Ellipsoid> around = std::nullopt;
  const auto consider = [&](const LineForm& form) {
    const auto cut_set = cut_by(enclose(Zonotope{form.c, form.G}, criterion).set, hull, criterion);
    if (!cut_set || (around && length(around->L.reshaped()) <= length(cut_set->L.reshaped())))
      return cut_set.has_value();
    around = cut_set;
    return true;
  };
  if (!consider(make_box(hull))) return std::nullopt;
  if (free.constraints() == 0 && !consider(free)) return std::nullopt;
  return EnclosingEllipsoid{*around, false};
}

Ellipsoid convex_hull(const Ellipsoid& X, const Ellipsoid& Y) {
  require_size(Y.dim(), X.dim(), "convex hull of ellipsoids", "the other set");
  const Index n = X.dim();
  Ellipsoid both{X.c / 2 + Y.c / 2, Matrix(n, X.L.cols() + Y.L.cols()), X.r.cwiseMax(Y.r)};
  both.L << X.L, Y.L;
  both.r += 4 * unit * (X.c.cwiseAbs() + Y.c.cwiseAbs());
  both.r.array() += 4 * rounding::tiny;
  EllipsoidSum sum(Vector::Zero(n));
  sum.add(Matrix::Identity(n, n), both);
  sum.add(Matrix::Identity(n, n), Zonotope{Vector::Zero(n), Matrix(X.c / 2 - Y.c / 2)});
  return sum.enclosed().set;
}

Zonotope principal_box(const Ellipsoid& X) {
  const Ellipsoid principal = X.axes() > 1 ? with_principal_axes(X) : X;
  Matrix G(X.dim(), principal.L.cols() + X.dim());
  Index used = 0;
  for (Index j = 0; j < principal.L.cols(); ++j) {
    if (!principal.L.col(j).isZero(0)) G.col(used++) = principal.L.col(j);
  }
  for (Index i = 0; i < X.dim(); ++i) {
    if (principal.r[i] > 0) G.col(used++) = principal.r[i] * Vector::Unit(X.dim(), i);
  }
  return {principal.c, G.leftCols(used)};
}

double support(const Ellipsoid& X, VectorIn d) {
  require_size(d.size(), X.dim(), "support of an ellipsoid", "the direction");
  double round = 0;
  if (X.L.cols() > 0) {
    round = length_up(linalg::transposed_product(X.L, Matrix(d)));
    if (round > 0 || !d.isZero(0)) round += product_slack(X.L, d);
  }
  return rounding::up(rounding::dot(d, X.c).upper +
                      rounding::up(rounding::up(round) + weighted(d, X.r)) * enlarge);
}

Box interval_hull(const Ellipsoid& X) {
  Box hull{X.c, X.c};
  for (Index i = 0; i < X.dim(); ++i) {
    const double radius = rounding::up(length_up(X.L.row(i)) + X.r[i]);
    if (length_up(X.L.row(i)) == 0 && X.r[i] == 0) continue;
    hull.lower[i] = rounding::down(X.c[i] - radius);
    hull.upper[i] = rounding::up(X.c[i] + radius);
  }
  return hull;
}

Answer contains(const Ellipsoid& X, VectorIn x) {
  require_size(x.size(), X.dim(), "contains of an ellipsoid", "the point");
  const Vector offset = x - X.c;
  const linalg::Svd svd = linalg::svd(X.L);
  const double largest = svd.sigma.size() ? svd.sigma[0] : 0;
  // the factors u that come nearest, over the axes that are not negligible
  Vector u = Vector::Zero(X.L.cols()), normal = Vector::Zero(X.dim());
  Index rank = 0;
  for (; rank < svd.sigma.size() && svd.sigma[rank] > 1e-12 * largest; ++rank) {
    const double t = svd.U.col(rank).dot(offset) / svd.sigma[rank];
    u += t * svd.V.col(rank);
    normal += t / svd.sigma[rank] * svd.U.col(rank);
  }
  const Matrix factors = u;
  const Vector missing = offset - linalg::product(X.L, factors);
  const Vector left = missing.cwiseAbs() + row_sums(rounding::product_error(X.L, factors)) +
                      4 * unit * (x.cwiseAbs() + X.c.cwiseAbs() + offset.cwiseAbs());
  const bool repaired_by_box = (left.array() <= X.r.array()).all();
  // with axes in all directions L v = `left` has a solution v with ‖v‖ ≤ ‖left‖ / σ_min
  const double unsure = 1e-13 * static_cast<double>(X.dim()) * largest;
  const double smallest = rank == X.dim() && rank > 0 ? svd.sigma[rank - 1] - unsure : 0;
  const double repair = repaired_by_box ? 0 : smallest > 0 ? length_up(left) / smallest : infinity;
  if ((length_up(u) + repair) * enlarge <= 1) return Answer::yes;
  for (const Vector& d : {normal, missing}) {
    if (!d.allFinite() || d.isZero(0)) continue;
    const double margin =
        tolerances::proof_margin * (weighted(d, x.cwiseAbs()) + weighted(d, X.c.cwiseAbs()));
    if (rounding::dot(d, x).lower > support(X, d) * (1 + 4 * unit) + margin) return Answer::no;
  }
  return Answer::unknown;
}

std::optional<EllipsoidVolume> volume(const Ellipsoid& X) {
  const Index n = X.dim();
  if (X.L.cols() < n || n == 0) return std::nullopt;
  const Vector sigma = linalg::svd(X.L).sigma;
  const double unsure = 1e-14 * static_cast<double>(n) * sigma[0];
  if (!(sigma[n - 1] > 1e6 * unsure)) return std::nullopt;
  const double half = static_cast<double>(n) / 2;
  const double ball =
      std::exp(half * std::log(std::numbers::pi) - std::lgamma(half + 1)) * sigma.prod();
  // the rounding box lies in (‖r‖ / σ_min) L u; every axis may be off by `unsure`
  double guard = 1 + 1e-12;
  for (Index i = 0; i < n; ++i)
    guard *= 1 + unsure / sigma[i] + length_up(X.r) / (sigma[n - 1] - unsure);
  return EllipsoidVolume{ball * guard, guard <= 1 + 1e-8};
}

}  // namespace cordon::sets
