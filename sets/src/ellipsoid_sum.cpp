// SPDX-License-Identifier: GPL-3.0-or-later
// Sums of ellipsoids: least trace, then a triangular factor by plane rotations.
#include <algorithm>
#include <cmath>

#include "cordon/core/linalg.hpp"
#include "cordon/sets/ellipsoid.hpp"
#include "ellipsoid_bounds.hpp"
#include "require.hpp"

namespace cordon::sets {

namespace {

using namespace ellipsoids;

/// A column that is this share of its rows is rounding noise: it joins the rounding box, for a
/// weight of least trace would make a half axis of the root of the share of it.
const double noise_share = std::ldexp(1.0, -40);
/// A coordinate of the rounding box is taken into the ellipsoid when it has grown to this share of
/// the row, and is no plain rounding of the centre.
const double fold_share = std::ldexp(1.0, -36), centre_share = std::ldexp(1.0, -44);
/// Numbers below are no better than underflow: their quotients may be off by more than units of the
/// last place.
constexpr double smallest = 1e-280;
/// P (1 + p) + B (1 + 1/p) encloses a sum for every p > 0: this one for a folded rounding box.
const double fold_weight = std::ldexp(1.0, -26);

/// The rotation that turns (x, y) to (h, 0).
struct Rotation {
  double c, s, h;
};
Rotation rotation(double x, double y) {
  const double square = x * x + y * y;
  const double h = square > 1e-270 && square < 1e270 ? std::sqrt(square) : std::hypot(x, y);
  return {x / h, y / h, h};
}

/// B = [R 0] Q + E for an orthogonal Q and a lower triangular R in place of B; the rows of E are
/// added to r, so that {B u : ‖u‖ ≤ 1} ⊆ {R v + w : ‖v‖ ≤ 1, |w| ≤ r}. A computed rotation has c
/// and s within 3.1 u of the exact ones, and an entry c p + s q within another 2.1 u: a row is off
/// by less than √2 · 5.3 u of its norm in each rotation that it takes part in, and all exact
/// rotations keep norms.
void make_triangular(Matrix& B, Vector& r) {
  const Index n = B.rows(), m = B.cols();
  Vector norms(n);
  for (Index i = 0; i < n; ++i) norms[i] = length_up(B.row(i));
  Index rotations = 0;
  for (Index i = 0; i < n; ++i) {
    for (Index j = m - 1; j > i; --j) {
      if (B(i, j) == 0) continue;
      const Rotation turn = rotation(B(i, i), B(i, j));
      if (turn.h < smallest) {
        r[i] += std::abs(B(i, j)) + rounding::tiny;
        B(i, j) = 0;
        continue;
      }
      B(i, i) = turn.h;
      B(i, j) = 0;
      for (Index k = i + 1; k < n; ++k) {
        const double p = B(k, i), q = B(k, j);
        B(k, i) = turn.c * p + turn.s * q;
        B(k, j) = turn.c * q - turn.s * p;
      }
      ++rotations;
    }
    const double count = static_cast<double>(rotations);
    r[i] += 8 * unit * count * norms[i] * (1 + 8 * unit * count) + 4 * count * rounding::tiny;
  }
  B.conservativeResize(Eigen::NoChange, std::min(n, m));
}

}  // namespace

EllipsoidSum::EllipsoidSum(VectorIn f)
    : c_(f), magnitude_(f.cwiseAbs()), r_(Vector::Zero(f.size())) {}

/// c += T centre. r holds |T| ℓ for all ℓ whose share of rounding comes at the end.
void EllipsoidSum::add_centre(MatrixIn T, VectorIn c) {
  require_size(T.cols(), c.size(), "sum of ellipsoids", "a map");
  require_size(T.rows(), c_.size(), "sum of ellipsoids", "a map's image");
  c_ += linalg::product(T, Matrix(c));
  terms_ += T.cols() + 1;
}

void EllipsoidSum::add_block(Matrix block) {
  if (block.size() > 0 && !block.isZero(0)) blocks_.push_back(std::move(block));
}

void EllipsoidSum::add(MatrixIn T, const Ellipsoid& X) {
  add_centre(T, X.c);
  const Matrix size = T.cwiseAbs();
  magnitude_ += linalg::product(size, Matrix(X.c.cwiseAbs() + row_sums(X.L)));
  r_ += linalg::product(size, Matrix(X.r));
  if (X.L.cols() > 0) add_block(linalg::product(T, X.L));
}

void EllipsoidSum::add(MatrixIn T, const Zonotope& Z) {
  add_centre(T, Z.c);
  magnitude_ += linalg::product(T.cwiseAbs(), Matrix(Z.c.cwiseAbs() + row_sums(Z.G)));
  if (Z.generators() == 0) return;
  const Matrix G = linalg::product(T, Z.G);
  for (Index j = 0; j < G.cols(); ++j) add_block(G.col(j));
}

void EllipsoidSum::add_box(VectorIn radius) {
  require_size(radius.size(), c_.size(), "sum of ellipsoids", "a box");
  for (Index i = 0; i < radius.size(); ++i) {
    if (radius[i] > 0) blocks_.emplace_back(radius[i] * Vector::Unit(radius.size(), i));
  }
}

/// [w₁ B₁, w₂ B₂, …] with Σ 1/wᵢ² ≤ 1, whose ellipsoid encloses the sum of those of the blocks by
/// the Cauchy-Schwarz inequality: (Σ‖Bᵢᵀd‖)² ≤ Σ 1/wᵢ² · Σ wᵢ²‖Bᵢᵀd‖². wᵢ² = Σsⱼ / sᵢ with sᵢ =
/// ‖Bᵢ‖_F gives the least trace.
EllipsoidSum::Stacked EllipsoidSum::stacked(Vector& r) const {
  const Index n = c_.size();
  Vector rows = Vector::Zero(n);
  for (const Matrix& block : blocks_) rows += block.cwiseAbs().rowwise().sum();
  std::vector<const Matrix*> used;
  std::vector<double> sizes;
  Index columns = 0;
  for (const Matrix& block : blocks_) {
    if (block.cols() == 1 && (block.cwiseAbs().array() <= noise_share * rows.array()).all()) {
      r += block.cwiseAbs();
      continue;
    }
    used.push_back(&block);
    sizes.push_back(length(block.reshaped()));
    columns += block.cols();
  }
  // any sᵢ > 0 encloses: tiny ones are raised, so that their weights stay finite
  double total = 0;
  const double least =
      sizes.empty() ? 0 : std::ldexp(*std::max_element(sizes.begin(), sizes.end()), -100);
  for (double& size : sizes) total += size = std::max(size, least);
  Stacked result{Matrix(n, columns), static_cast<Index>(used.size()), used.size() < blocks_.size()};
  const double guard = 1 + 4 * (static_cast<double>(used.size()) + 4) * unit;
  Index at = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const double weight = used.size() == 1 ? 1 : std::sqrt(total / sizes[i]) * guard;
    result.L.middleCols(at, used[i]->cols()) = *used[i] * weight;
    at += used[i]->cols();
  }
  if (result.noise) r *= 1 + rounding::gamma(static_cast<Index>(blocks_.size()) + 2);
  if (used.size() > 1) {
    r += 2 * unit * row_sums(result.L);
    r.array() += static_cast<double>(columns) * rounding::tiny;
  }
  return result;
}

/// Takes coordinates of the rounding box that have become large into L: {|w| ≤ r} of t coordinates
/// lies in {√t diag(r) u}.
bool EllipsoidSum::fold(Matrix& L, Vector& r) const {
  const Index n = L.rows();
  std::vector<Index> large;
  for (Index i = 0; i < n; ++i) {
    const double least = std::max(fold_share * L.row(i).cwiseAbs().sum(), smallest);
    if (r[i] > least && r[i] > centre_share * std::abs(c_[i])) large.push_back(i);
  }
  if (large.empty()) return false;
  const double p = L.isZero(0) ? 0 : fold_weight;
  const double root = std::sqrt(static_cast<double>(large.size())) * (1 + 8 * unit);
  const double own = p > 0 ? std::sqrt(1 + 1 / p) * root : root;
  const Index k = p > 0 ? L.cols() : 0;
  Matrix folded = Matrix::Zero(n, k + static_cast<Index>(large.size()));
  if (p > 0) folded.leftCols(k) = L * (std::sqrt(1 + p) * (1 + 8 * unit));
  for (std::size_t t = 0; t < large.size(); ++t) {
    const Index i = large[t];
    folded(i, k + static_cast<Index>(t)) = r[i] * own;
    r[i] = 0;
  }
  L = std::move(folded);
  r += 2 * unit * row_sums(L);
  r.array() += static_cast<double>(L.cols()) * rounding::tiny;
  return true;
}

EnclosingEllipsoid EllipsoidSum::enclosed() const {
  const Index n = c_.size();
  EnclosingEllipsoid result;
  Ellipsoid& X = result.set;
  X.c = c_;
  // every product and sum of centres and columns has at most `terms_` terms
  X.r = r_ * (1 + rounding::gamma(4 * terms_ + 16)) +
        magnitude_ * (rounding::gamma(2 * terms_ + 8) * (1 + rounding::gamma(2 * terms_)));
  X.r.array() += static_cast<double>(terms_ * 4 * (n + 4)) *
                 (magnitude_.isZero(0) && r_.isZero(0) ? 0 : rounding::tiny);
  if (terms_ == 1) X.r.setZero();  // f alone
  Stacked sum = stacked(X.r);
  X.L = std::move(sum.L);
  result.exact = (sum.blocks <= 1 || n <= 1) && !sum.noise;
  if (fold(X.L, X.r)) result.exact = false;
  if (X.L.cols() > n) make_triangular(X.L, X.r);
  X.r *= enlarge;
  if (!X.c.allFinite() || !X.L.allFinite() || !X.r.allFinite())
    throw Error(Errc::not_finite, "ellipsoid: an operation overflows; scale the problem");
  return result;
}

}  // namespace cordon::sets
