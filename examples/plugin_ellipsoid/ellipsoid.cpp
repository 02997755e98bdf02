// SPDX-License-Identifier: GPL-3.0-or-later
#include "ellipsoid.hpp"

#include <algorithm>
#include <cmath>
#include <cordon/core/error.hpp>
#include <cordon/core/linalg.hpp>
#include <cordon/core/rounding.hpp>
#include <cordon/solvers/set_questions.hpp>
#include <limits>
#include <numbers>

#include "bounds.hpp"

namespace ellipsoid {

namespace {

namespace linalg = cordon::linalg;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// A set is called empty, a point outside, if this share of the terms cannot explain it.
constexpr double proof_margin = 1e-10;
/// A rounding box that has grown to this share of the ellipsoid is taken into it.
const double fold_share = std::ldexp(1.0, -36);

bool is_finite(const Ellipsoid& X) { return X.c.allFinite() && X.L.allFinite() && X.r.allFinite(); }

Ellipsoid checked(Ellipsoid X) {
  if (is_finite(X)) return X;
  throw cordon::Error(cordon::Errc::unsupported,
                      "ellipsoid: the result is too large for double precision");
}

/// The same set with an L of orthogonal columns, at most n. With L = U diag(σ) Vᵀ + E: L u = U
/// diag(σ) (Vᵀu) + E u, where ‖Vᵀu‖ is 1 up to the defect of V and |E u| is taken up by the
/// rounding box.
Ellipsoid with_principal_axes(const Ellipsoid& X) {
  if (X.L.cols() == 0 || X.dim() == 0) return {X.c, Matrix(X.dim(), 0), X.r, X.empty};
  const linalg::Svd svd = linalg::svd(X.L);
  const Index k = svd.sigma.size();
  const Matrix V = svd.V.leftCols(k), axes = svd.U.leftCols(k) * svd.sigma.asDiagonal();
  const Matrix back = linalg::product(axes, V.transpose()),
               error = rounding::product_error(axes, V.transpose());
  const Matrix gram = linalg::product(V.transpose(), V);
  const double defect =
      (gram - Matrix::Identity(k, k)).norm() + rounding::product_error(V.transpose(), V).norm();
  Ellipsoid result{X.c, axes * (1 + 2 * defect),
                   X.r + row_sums((X.L - back).cwiseAbs() + error + 2 * unit * X.L.cwiseAbs()),
                   X.empty};
  result.r = (result.r + 4 * unit * row_sums(result.L)) * enlarge;
  return result;
}

/// [w₁ B₁, w₂ B₂, …] with Σ 1/wᵢ² ≤ 1, whose ellipsoid encloses the sum of those of the blocks by
/// the Cauchy-Schwarz inequality: (Σ‖Bᵢᵀd‖)² ≤ Σ 1/wᵢ² · Σ wᵢ²‖Bᵢᵀd‖². wᵢ² = Σsⱼ / sᵢ with sᵢ =
/// ‖Bᵢ‖_F gives the least trace. Zero blocks are left out.
struct Stacked {
  Matrix L;
  Index blocks = 0;  ///< that are not zero
};
Stacked stack(Index n, std::span<const Matrix> blocks) {
  std::vector<const Matrix*> used;
  std::vector<double> sizes;
  double total = 0;
  Index columns = 0;
  for (const Matrix& block : blocks) {
    const double size = block.size() ? block.stableNorm() : 0;
    if (size == 0) continue;
    used.push_back(&block);
    sizes.push_back(size);
    columns += block.cols();
  }
  // any sᵢ > 0 encloses: tiny ones are raised, so that their weights stay finite
  const double least =
      sizes.empty() ? 0 : std::ldexp(*std::max_element(sizes.begin(), sizes.end()), -100);
  for (double& size : sizes) total += size = std::max(size, least);
  Stacked result{Matrix(n, columns), static_cast<Index>(used.size())};
  const double guard = 1 + 4 * (static_cast<double>(used.size()) + 4) * unit;
  Index at = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const double weight = used.size() == 1 ? 1 : std::sqrt(total / sizes[i]) * guard;
    result.L.middleCols(at, used[i]->cols()) = *used[i] * weight;
    at += used[i]->cols();
  }
  return result;
}

/// Takes the rounding box into the ellipsoid when it has become large beside it: {|w| ≤ r} ⊆ {√n
/// diag(r) u}.
Result folded(Ellipsoid X, bool exact) {
  const double size = X.L.size() ? X.L.stableNorm() : 0;
  if (size > 0 && X.r.size() && X.r.maxCoeff() > fold_share * size) {
    const double root = std::sqrt(static_cast<double>(X.dim())) * (1 + 4 * unit);
    const Matrix blocks[] = {X.L, (X.r * root).asDiagonal()};
    X.L = stack(X.dim(), blocks).L;
    X.r = 4 * unit * row_sums(X.L);
    exact = false;
  }
  if (X.L.cols() > X.dim() && !exact) X = with_principal_axes(X);
  return {checked(std::move(X)), exact};
}

/// The share κ = a²/b² of the cut ellipsoid for the unit ball and α ≤ t ≤ β, μ = (α+β)/2, h =
/// (β-α)/2 > 0, B = 1 - μ² - h² ≥ 0. Any κ in (0,1] gives an enclosure; `along` and `across` are
/// the parts of tr(L Lᵀ) along and across the direction, k columns.
double best_share(Criterion criterion, double mu, double h, double B, double along, double across,
                  double k) {
  const double least = h * h;  // keeps b² = B + h²/κ + μ²κ below 3
  double share = 1;
  if (criterion == Criterion::volume) {
    // the stationary point of κ (b²)ᵏ: (k+1) μ² κ² + B κ = (k-1) h²
    share = 2 * (k - 1) * h * h / (B + std::sqrt(B * B + 4 * (k * k - 1) * mu * mu * h * h));
  } else {
    // that of along·κ b² + across·b², whose derivative increases with κ
    const auto slope = [&](double x) {
      return along * (B + 2 * mu * mu * x) + across * (mu * mu - h * h / (x * x));
    };
    if (slope(1) > 0) {
      double low = least, high = 1;
      for (int step = 0; step < 60 && high > low * (1 + 1e-9); ++step) {
        const double middle = std::sqrt(low * high);
        (slope(middle) > 0 ? high : low) = middle;
      }
      share = high;
    }
  }
  return std::isnan(share) ? 1 : std::clamp(share, least, 1.0);
}

/// The strip in the coordinate t = ĝᵀu of the unit ball, ĝ = g/‖g‖.
struct Slab {
  double lower, upper;  ///< α, β in [-1, 1]
  double shift;         ///< points of the slab are within this of α ≤ t ≤ β
};

/// X shrunk to the slab: with t = ĝᵀu and ρ² = ‖u‖² - t², the ellipsoid (t - m)²/a² + ρ²/b² ≤ 1
/// contains α ≤ t ≤ β, ρ² ≤ 1 - t². For a ≤ b the left-hand side is convex in t along ρ² = 1 - t²,
/// so that the two ends decide: m = μ(1-κ), b² = 1 - μ² - h² + h²/κ + μ²κ, a² = κ b². What is
/// uncertain about t moves points by as much along L ĝ, which the rounding box takes up.
Ellipsoid shrunk(const Ellipsoid& X, const Vector& g, const Slab& slab, Criterion criterion) {
  const Index k = X.L.cols();
  const double e = (static_cast<double>(k) + 16) * unit, shift = slab.shift + e;
  const Vector direction = g / g.stableNorm();
  const Matrix column = direction;
  const Vector v = linalg::product(X.L, column);
  const Vector v_error = row_sums(rounding::product_error(X.L, column)) +
                         e * linalg::product(X.L.cwiseAbs(), column.cwiseAbs());
  const double mu = (slab.lower + slab.upper) / 2, h = (slab.upper - slab.lower) / 2;
  const double ball = 1 + 4 * shift,
               B = std::max(0.0, ball - mu * mu - h * h);  // of the squared radius
  double a = 0, b = 0, m = mu;
  if (k == 1) {
    a = b = h * (1 + 16 * unit);  // a segment: nothing lies across
  } else if (h == 0) {
    b = std::sqrt(B) * (1 + 16 * unit);
  } else {
    const double along = v.squaredNorm(), across = std::max(0.0, X.L.squaredNorm() - along);
    const double share = best_share(criterion, mu, h, B, along, across, static_cast<double>(k));
    if (share == 1) return X;
    const double b_squared = B + h * h / share + mu * mu * share;
    a = std::sqrt(share * b_squared) * (1 + 16 * unit);
    b = std::sqrt(b_squared) * (1 + 16 * unit);
    m = mu * (1 - share);
  }
  Ellipsoid result;
  result.c = X.c + m * v;
  result.L = b * X.L + (a - b) * v * direction.transpose();
  const double length = direction.cwiseAbs().sum();
  const Vector spread = v.cwiseAbs() + v_error;
  result.r = X.r + (shift + e) * spread + (std::abs(m) + std::abs(a - b) * length) * v_error;
  result.r += 8 * unit * (X.c.cwiseAbs() + spread) +
              (e + 8 * unit) * (b * row_sums(X.L) + std::abs(a - b) * length * spread);
  result.r *= enlarge;
  // of a strip that is thinner than its own uncertainty the guards may outweigh the gain
  const bool worse = criterion == Criterion::trace && result.L.stableNorm() >= X.L.stableNorm();
  return is_finite(result) && !worse ? result : X;
}

}  // namespace

Index Ellipsoid::axes() const {
  Index count = 0;
  for (Index j = 0; j < L.cols(); ++j) count += L.col(j).isZero(0) ? 0 : 1;
  return std::min(count, dim());
}

Ellipsoid make_empty(Index n) { return {Vector::Zero(n), Matrix(n, 0), Vector::Zero(n), true}; }

Ellipsoid affine_map(const Ellipsoid& X, MatrixIn T, VectorIn t) {
  if (X.empty) return make_empty(T.rows());
  const Matrix centre = X.c, box = X.r;
  Ellipsoid result;
  result.L = linalg::product(T, X.L);
  result.c = linalg::product(T, centre) + t;
  result.r = linalg::product(T.cwiseAbs(), box) * (1 + rounding::gamma(2 * T.cols() + 2)) +
             row_sums(rounding::product_error(T, X.L)) +
             row_sums(rounding::product_error(T, centre)) +
             2 * unit * (result.c.cwiseAbs() + t.cwiseAbs());
  result.r *= enlarge;
  return checked(std::move(result));
}

Result sum(std::span<const Ellipsoid> summands) {
  const Index n = summands.front().dim();
  std::vector<Matrix> blocks;
  Ellipsoid result{Vector::Zero(n), {}, Vector::Zero(n)};
  Vector magnitude = Vector::Zero(n);
  for (const Ellipsoid& X : summands) {
    if (X.empty) return {make_empty(n), true};
    blocks.push_back(X.L);
    result.c += X.c;
    result.r += X.r;
    magnitude += X.c.cwiseAbs();
  }
  const Stacked stacked = stack(n, blocks);
  result.L = stacked.L;
  if (stacked.blocks > 1) result.r += 2 * unit * row_sums(result.L);
  if (summands.size() > 1)
    result.r += rounding::gamma(2 * static_cast<Index>(summands.size())) * magnitude;
  result.r *= 1 + rounding::gamma(4 * static_cast<Index>(summands.size()) + 16);
  return folded(std::move(result), stacked.blocks <= 1);
}

Ellipsoid cut(const Ellipsoid& given, const Strip& strip, Criterion criterion) {
  if (given.empty) return given;
  const Ellipsoid X = given.L.cols() > given.dim() ? with_principal_axes(given) : given;
  const Matrix a = strip.a;
  const Vector g = linalg::product(X.L.transpose(), a);
  const double reach = g.size() ? g.stableNorm() : 0;
  const cordon::Interval centre = rounding::dot(strip.a, X.c);
  const double middle = (centre.lower + centre.upper) / 2;
  // everything that aᵀc, g and the rounding box leave open
  const double slack = ((centre.upper - centre.lower) +
                        norm_bound(rounding::product_error(X.L.transpose(), a).rowwise().sum()) +
                        weighted(strip.a, X.r) + strip.error) *
                       enlarge;
  const double beyond = std::max(strip.lower - middle, middle - strip.upper) - reach;
  const double nearer = strip.lower - middle > middle - strip.upper ? strip.lower : strip.upper;
  const double magnitude = weighted(strip.a, X.c.cwiseAbs()) + reach + std::abs(nearer);
  if (beyond > slack + proof_margin * magnitude) return make_empty(X.dim());
  if (!(reach > 0) || !std::isfinite(slack)) return given;
  // A wide strip is widened by the slack; of a thin one (an equation) the slack moves points
  // instead, and the cut stays thin.
  const bool wide = strip.upper - strip.lower > std::ldexp(slack, 20);
  const double widening = wide ? slack / reach + 16 * unit : 0,
               shift = wide ? 0 : slack / reach + 16 * unit;
  if (shift > std::ldexp(1.0, -20)) return given;
  const Slab slab{std::clamp((strip.lower - middle) / reach - widening, -1.0, 1.0),
                  std::clamp((strip.upper - middle) / reach + widening, -1.0, 1.0), shift};
  if (slab.lower == -1 && slab.upper == 1) return given;
  return shrunk(X, g, slab, criterion);
}

Ellipsoid intersection(const Ellipsoid& X, MatrixIn R, const Ellipsoid& Y, Criterion criterion) {
  if (X.empty || Y.empty) return make_empty(X.dim());
  const Matrix directions =
      Y.L.cols() > 0 ? linalg::svd(Y.L).U : Matrix::Identity(Y.dim(), Y.dim());
  const Matrix rows = linalg::product(R.transpose(), directions),
               error = rounding::product_error(R.transpose(), directions);
  Ellipsoid result = X;
  for (Index j = 0; j < directions.cols() && !result.empty; ++j) {
    const Box hull = interval_hull(result);
    const double uncertain =
        weighted(error.col(j), hull.lower.cwiseAbs().cwiseMax(hull.upper.cwiseAbs()));
    const Vector d = directions.col(j);
    result = cut(result, {rows.col(j), -support(Y, -d), support(Y, d), uncertain}, criterion);
  }
  return result;
}

Ellipsoid convex_hull(const Ellipsoid& X, const Ellipsoid& Y) {
  const Index n = X.dim();
  Ellipsoid both{X.c / 2 + Y.c / 2, Matrix(n, X.L.cols() + Y.L.cols()), X.r.cwiseMax(Y.r)};
  both.L << X.L, Y.L;
  both.r += 4 * unit * (X.c.cwiseAbs() + Y.c.cwiseAbs());
  const Ellipsoid terms[] = {both, {Vector::Zero(n), X.c / 2 - Y.c / 2, Vector::Zero(n)}};
  return sum(terms).set;
}

Result enclose(const LineForm& X, Criterion criterion) {
  const LineForm form = X.lines() > 0 ? cordon::eliminate_lines(X) : X;
  const Index n = form.dim();
  if (form.constraints() > 0 && cordon::is_empty(form) == Answer::yes) return {make_empty(n), true};
  if (form.lines() > 0)
    throw cordon::Error(cordon::Errc::unsupported, "ellipsoid holds bounded sets only");
  const auto around_zonotope = [&](const Vector& c, const Matrix& G) {
    std::vector<Matrix> generators;
    for (Index j = 0; j < G.cols(); ++j) generators.push_back(G.col(j));
    const Stacked stacked = stack(n, generators);
    const bool exact = stacked.blocks <= 1 || n <= 1;
    Result result = folded({c, stacked.L, 4 * unit * row_sums(stacked.L)}, exact);
    if (stacked.L.cols() > n) result.set = checked(with_principal_axes(result.set));
    return result;
  };
  Result result = around_zonotope(form.c, form.G);
  if (form.constraints() == 0) return result;
  result.exact = false;
  const Box hull = cordon::interval_hull(form);
  if (hull.is_empty()) return {make_empty(n), true};
  for (Index i = 0; i < n && !result.set.empty; ++i) {
    result.set = cut(result.set, {Vector::Unit(n, i), hull.lower[i], hull.upper[i]}, criterion);
  }
  if (!result.set.empty && hull.is_bounded()) {
    const LineForm box = cordon::make_box(hull);
    const Result other = around_zonotope(box.c, box.G);
    if (other.set.L.norm() < result.set.L.norm()) result.set = other.set;
  }
  return result;
}

LineForm principal_box(const Ellipsoid& X) {
  if (X.empty) return cordon::make_empty(X.dim());
  const Ellipsoid principal = X.axes() > 1 ? with_principal_axes(X) : X;
  Matrix G(X.dim(), principal.L.cols() + X.dim());
  Index used = 0;
  for (Index j = 0; j < principal.L.cols(); ++j) {
    if (!principal.L.col(j).isZero(0)) G.col(used++) = principal.L.col(j);
  }
  for (Index i = 0; i < X.dim(); ++i) {
    if (principal.r[i] > 0) G.col(used++) = principal.r[i] * Vector::Unit(X.dim(), i);
  }
  return cordon::make_zonotope(principal.c, G.leftCols(used));
}

double support(const Ellipsoid& X, VectorIn d) {
  if (X.empty) return -infinity;
  const Matrix column = d;
  const Vector g = linalg::product(X.L.transpose(), column);
  const double round =
      norm_bound(g) + norm_bound(rounding::product_error(X.L.transpose(), column).rowwise().sum());
  return rounding::up(
      (rounding::dot(d, X.c).upper + rounding::up(rounding::up(round) + weighted(d, X.r))));
}

Box interval_hull(const Ellipsoid& X) {
  if (X.empty) return X.dim() > 0 ? Box::empty(X.dim()) : Box{Vector(0), Vector(0)};
  Box hull{X.c, X.c};
  for (Index i = 0; i < X.dim(); ++i) {
    const double radius = rounding::up(norm_bound(X.L.row(i).transpose()) + X.r[i]);
    if (radius == 0) continue;
    hull.lower[i] = rounding::down(X.c[i] - radius);
    hull.upper[i] = rounding::up(X.c[i] + radius);
  }
  return hull;
}

Answer contains(const Ellipsoid& X, VectorIn x) {
  if (X.empty) return Answer::no;
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
                      4 * unit * (x.cwiseAbs() + X.c.cwiseAbs());
  const bool repaired_by_box = (left.array() <= X.r.array()).all();
  // with axes in all directions L v = `left` has a solution v with ‖v‖ ≤ ‖left‖ / σ_min
  const double smallest = rank == X.dim() && rank > 0 ? svd.sigma[rank - 1] - 1e-13 * largest : 0;
  const double repair = repaired_by_box ? 0 : smallest > 0 ? norm_bound(left) / smallest : infinity;
  if (norm_bound(u) + repair <= 1) return Answer::yes;
  for (const Vector& d : {normal, missing}) {
    if (!d.allFinite() || d.isZero(0)) continue;
    const double margin = proof_margin * (weighted(d, x.cwiseAbs()) + weighted(d, X.c.cwiseAbs()));
    if (rounding::dot(d, x).lower > support(X, d) * (1 + 4 * unit) + margin) return Answer::no;
  }
  return Answer::unknown;
}

double volume(const Ellipsoid& X) {
  const Index n = X.dim();
  if (X.L.cols() < n) return -1;
  const Vector sigma = linalg::svd(X.L).sigma;
  if (X.r.maxCoeff() > 1e-12 * sigma[n - 1]) return -1;
  const double half = static_cast<double>(n) / 2;
  return std::exp(half * std::log(std::numbers::pi) - std::lgamma(half + 1)) * sigma.prod() *
         (1 + static_cast<double>(n) * 1e-11);
}

}  // namespace ellipsoid
