// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/milp/pair_reduction.hpp"

#include <cmath>
#include <limits>
#include <random>

#include "cordon/core/linalg.hpp"
#include "cordon/sets/constraint_elimination.hpp"
#include "cordon/sets/generator_reduction.hpp"
#include "cordon/solvers/lp.hpp"

namespace cordon::designers {

namespace {

constexpr double input_rank =
    1e-9;  ///< singular values of N below this share of the largest count as zero
constexpr double flat_pair =
    1e-3;  ///< directions narrower than this share of what they are compared with are padded

/// Points of U are point + directions·ζ with ‖ζ‖∞ ≤ √g.
struct AffineHull {
  Vector point;
  Matrix directions;
};

AffineHull affine_hull(const InputSequences& U) {
  if (U.b.size() == 0) return {U.c, U.G};
  return {U.c + linalg::product(U.G, linalg::product(linalg::pseudo_inverse(U.A), U.b)),
          linalg::product(U.G, linalg::null_space(U.A))};
}

/// Without entries that are rounding noise in their row and columns that are left empty; the rest
/// is made larger by far more.
Matrix without_noise(Matrix G) {
  constexpr double noise = 1e-13, more = 1e-11;
  const Vector size = G.cwiseAbs().rowwise().sum();
  Index count = 0;
  for (Index j = 0; j < G.cols(); ++j) {
    for (Index i = 0; i < G.rows(); ++i) {
      if (std::abs(G(i, j)) <= noise * size[i]) G(i, j) = 0;
    }
    if ((G.col(j).array() != 0).any()) G.col(count++) = G.col(j) * (1 + more);
  }
  return G.leftCols(count);
}

/// One generator for all that are parallel: the same set.
Matrix without_parallels(const Matrix& G) {
  Matrix kept(G.rows(), G.cols());
  Index count = 0;
  for (Index j = 0; j < G.cols(); ++j) {
    const double size = G.col(j).norm();
    if (size == 0) continue;
    Index k = 0;
    double cosine = 0;
    for (; k < count; ++k) {
      cosine = kept.col(k).dot(G.col(j)) / (kept.col(k).norm() * size);
      if (std::abs(cosine) > 1 - 1e-15) break;
    }
    if (k == count) {
      kept.col(count++) = G.col(j);
    } else {
      kept.col(k) += (cosine > 0 ? 1 : -1) * G.col(j);
    }
  }
  return kept.leftCols(count);
}

/// Generators along directions in which G, compared with `size` row by row, is narrow.
Matrix padding(const Matrix& G, const Vector& size) {
  const linalg::Svd parts = linalg::svd(size.cwiseInverse().asDiagonal() * G);
  Matrix pads(G.rows(), G.rows());
  Index count = 0;
  for (Index k = 0; k < G.rows(); ++k) {
    const double sigma = k < parts.sigma.size() ? parts.sigma[k] : 0;
    if (sigma < flat_pair) pads.col(count++) = size.asDiagonal() * parts.U.col(k) * flat_pair;
  }
  return pads.leftCols(count);
}

/// h(d) = max{dᵀ(c + Gξ) : Aξ = b, ‖ξ‖∞ ≤ 1} for each row d; NaN where the solver has no answer.
Vector supports(const Matrix& directions, const Vector& c, const Matrix& G, const Matrix& A,
                const Vector& b) {
  LinearProgram program(A, b, Vector::Constant(G.cols(), -1), Vector::Ones(G.cols()));
  Vector h(directions.rows());
  const Matrix objectives = linalg::product(directions, G);
  for (Index k = 0; k < directions.rows(); ++k) {
    const auto solution = program.maximize(objectives.row(k).transpose());
    h[k] = solution.status == LinearProgram::Status::optimal
               ? directions.row(k).dot(c) + solution.objective
               : std::numeric_limits<double>::quiet_NaN();
  }
  return h;
}

/// ± axes and random directions, as rows, in units of `width`.
Matrix sampled_directions(const Vector& width) {
  constexpr Index random = 24;
  const Index r = width.size(), half = r + (r > 1 ? random : 0);
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal;
  Matrix directions(2 * half, r);
  directions.topRows(r).setIdentity();
  for (Index k = r; k < half; ++k) {
    for (Index i = 0; i < r; ++i) directions(k, i) = normal(engine);
    directions.row(k).normalize();
  }
  directions.bottomRows(half) = -directions.topRows(half);
  return directions * width.cwiseInverse().asDiagonal();
}

/// How much wider than `exact` the set is in the mean, in units of widths.
double widening(const Matrix& directions, const Vector& exact, const Vector& wide) {
  const Index half = directions.rows() / 2;
  double sum = 0;
  for (Index k = 0; k < half; ++k) {
    const double width = exact[k] + exact[half + k];
    sum += (wide[k] + wide[half + k] - width) / std::max(width, 1e-9);
  }
  return std::isnan(sum) ? infinity : sum / static_cast<double>(half);
}

/// The constrained zonotope that R N u is compared with, and what N u reaches.
struct Separated {
  LineForm set;
  Matrix N;      ///< R N
  Vector reach;  ///< of |N u - c|, by row
};

Separated separate(const PairProgram& pair, const InputSequences& U) {
  const AffineHull hull = affine_hull(U);
  Matrix rows(pair.rows(), pair.G.cols() + pair.N.cols());
  rows << pair.G, pair.N;
  const Vector scale = linalg::row_scales(rows), c = scale.cwiseProduct(pair.c);
  const Matrix N = scale.asDiagonal() * pair.N, G = scale.asDiagonal() * pair.G;
  const linalg::Svd parts = linalg::svd(linalg::product(N, hull.directions));
  const double largest = parts.sigma.size() > 0 ? parts.sigma[0] : 0;
  const Index r = largest > 0 ? (parts.sigma.array() > input_rank * largest).count() : 0;
  const Matrix R = parts.U.leftCols(r).transpose(),
               L = parts.U.rightCols(pair.rows() - r).transpose();
  const Vector at_point = linalg::product(N, hull.point) - c;
  Separated result{{Matrix(r, 0), linalg::product(R, G), R * c, Matrix(L.rows(), 0),
                    linalg::product(L, G), L * at_point},
                   linalg::product(R, N),
                   (R * at_point).cwiseAbs()};
  result.reach += linalg::product(result.N, hull.directions).cwiseAbs().rowwise().sum();
  return result;
}

/// The rows [G; A]ξ + [c; -b] of `Y` with generators that span them, each in units of its
/// generators.
struct Rows {
  Matrix G;
  Vector c, unit;
};

Rows spanned(const LineForm& Y, const Vector& reach) {
  const Index m = Y.dim() + Y.constraints();
  Matrix G(m, Y.generators());
  G << Y.G, Y.A;
  Vector c(m), size(m);
  c << Y.c, -Y.b;
  size << reach, Y.b.cwiseAbs();
  size = size.cwiseMax(G.cwiseAbs().rowwise().sum()).cwiseMax(1e-12);
  const Matrix pads = padding(G, size);
  G.conservativeResize(Eigen::NoChange, G.cols() + pads.cols());
  G.rightCols(pads.cols()) = pads;
  const Vector unit = G.cwiseAbs().rowwise().sum().cwiseInverse();
  return {without_parallels(unit.asDiagonal() * G), unit.cwiseProduct(c), unit};
}

}  // namespace

bool inputs_enter(const PairProgram& pair, const InputSequences& U) {
  return separate(pair, U).set.dim() > 0;
}

std::optional<PairProgram> reduce_pair(const PairProgram& pair, const InputSequences& U,
                                       Index max_generators, Index max_constraints) {
  const auto [X, N, reach] = separate(pair, U);
  const Index r = X.dim();
  if (r == 0 || r > max_generators) return std::nullopt;
  const Matrix directions = sampled_directions(
      X.G.cwiseAbs().rowwise().sum().cwiseMax(flat_pair * reach).cwiseMax(1e-12));
  const Vector exact = supports(directions, X.c, X.G, X.A, X.b);
  std::optional<PairProgram> best;
  double least = infinity;
  Index constraints = std::min({max_constraints, max_generators - r, X.constraints()});
  for (bool last = false; !last; constraints /= 2) {
    last = constraints == 0;
    const LineForm Y = sets::eliminate_constraints(X, constraints).set;
    const Rows rows = spanned(Y, reach);
    const Index m = rows.c.size();
    for (const auto method :
         {sets::GeneratorReduction::girard, sets::GeneratorReduction::combastel,
          sets::GeneratorReduction::pca, sets::GeneratorReduction::yang_scott}) {
      const Matrix H = without_noise(sets::reduce_generators(rows.G, max_generators, method));
      const Matrix G = rows.unit.head(r).cwiseInverse().asDiagonal() * H.topRows(r);
      const Vector wide = supports(directions, Y.c, G, H.bottomRows(m - r), -rows.c.tail(m - r));
      const double loss = widening(directions, exact, wide);
      if (best && !(loss < least)) continue;
      least = loss;
      best = PairProgram{pair.i, pair.j, H, rows.c, Matrix::Zero(m, N.cols()), Vector::Zero(m)};
      best->N.topRows(r) = rows.unit.head(r).asDiagonal() * N;
    }
  }
  return best;
}

}  // namespace cordon::designers
