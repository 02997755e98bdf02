// SPDX-License-Identifier: GPL-3.0-or-later
// Ellipsoids cut by strips.
#include <algorithm>
#include <cmath>

#include "cordon/core/linalg.hpp"
#include "cordon/sets/ellipsoid.hpp"
#include "ellipsoid_bounds.hpp"
#include "require.hpp"

namespace cordon::sets {

namespace {

using namespace ellipsoids;

/// A slab of the unit ball that is thinner is flattened, and what it is thick joins the rounding
/// box: the best half axis along a slab of thickness h is about √h.
const double thin = std::ldexp(1.0, -40);

/// (1 - e)(1 + e), without cancellation.
double beyond(double e) { return (1 - e) * (1 + e); }

/// κ that makes along·κ b² + across·b² smallest: the root of B + 2μ²κ + ratio (μ² - h²/κ²), which
/// increases and is concave, by Newton's method from the left.
double least_trace(double mu, double h, double B, double ratio) {
  const double square = mu * mu, constant = B + ratio * square;
  if (!(ratio > 0)) return 0;
  if (constant + 2 * square - ratio * h * h <= 0) return 1;
  double share = h * std::sqrt(ratio / (constant + 2 * square));
  for (int step = 0; step < 50; ++step) {
    const double pull = ratio * h * h / (share * share);
    const double next =
        share - (constant + 2 * square * share - pull) / (2 * square + 2 * pull / share);
    if (!(next > share * (1 + 1e-13))) break;
    share = next;
  }
  return share;
}

/// The stationary point of κ (b²)ᵏ: (k+1) μ² κ² + B κ = (k-1) h².
double least_volume(double mu, double h, double B, double k) {
  const double root = std::sqrt(B * B + 4 * (k * k - 1) * mu * mu * h * h);
  return 2 * (k - 1) * h * h / (B + root);
}

/// The strip in the coordinate t = ĝᵀu of the unit ball, ĝ = g/‖g‖ for the g as computed.
struct Slab {
  double lower, upper;  ///< α ≤ t ≤ β holds for all points of the strip
};

/// u = m ĝ + (b I + (a - b) ĝ ĝᵀ) v, ‖v‖ ≤ 1, in place of ‖u‖ ≤ 1; `moved` is how far t may be from
/// there besides. With ĝ off by (k+4) u of its entries, L ĝ by another k u, and three operations
/// per entry of c and L, a row of L u is off by less than (4k+40) u (|m| + b) of its sum.
Ellipsoid replaced(const Ellipsoid& X, const Vector& g, double m, double a, double b,
                   double moved) {
  const Index n = X.dim(), k = X.L.cols();
  const Vector direction = g / length(g);
  const Vector v = linalg::product(X.L, Matrix(direction));
  const double share = static_cast<double>(4 * k + 40) * unit * (std::abs(m) + b);
  Ellipsoid result{Vector(n), Matrix(n, k), Vector(n)};
  for (Index j = 0; j < k; ++j) result.L.col(j) = b * X.L.col(j) + ((a - b) * direction[j]) * v;
  for (Index i = 0; i < n; ++i) {
    const double sum = X.L.row(i).cwiseAbs().sum();
    result.c[i] = X.c[i] + m * v[i];
    result.r[i] = (X.r[i] + moved * (std::abs(v[i]) + share * sum) + share * sum +
                   4 * unit * (std::abs(X.c[i]) + std::abs(m * v[i])) +
                   static_cast<double>(8 * (k + 2)) * rounding::tiny) *
                  enlarge;
  }
  if (k == 1) result.L = v * (a * direction[0]);  // a segment: nothing lies across
  return result;
}

std::optional<Ellipsoid> shrunk(const Ellipsoid& X, const Vector& g, const Slab& slab,
                                EllipsoidCriterion criterion) {
  const Index k = X.L.cols();
  const double mu = (slab.lower + slab.upper) / 2;
  // the middle is rounded, too
  const double h = std::max(slab.upper - mu, mu - slab.lower) * (1 + 4 * unit);
  if (k == 1) return replaced(X, g, mu, h, h, 0);
  if (h <= thin) {
    const bool central = slab.lower <= 0 && slab.upper >= 0;
    const double nearest = std::min(std::abs(slab.lower), std::abs(slab.upper));
    const double b = central ? 1 : std::sqrt(beyond(nearest)) * (1 + 8 * unit);
    return replaced(X, g, mu, 0, b, h);
  }
  const double along = length(linalg::product(X.L, Matrix(g / length(g)))),
               all = length(X.L.reshaped()) / along;
  const SlabEllipsoid best =
      slab_ellipsoid(slab.lower, slab.upper, criterion, std::max(0.0, (all - 1) * (all + 1)), k);
  if (best.a >= best.b) return std::nullopt;
  return replaced(X, g, best.m, best.a, best.b, 0);
}

}  // namespace

SlabEllipsoid slab_ellipsoid(double alpha, double beta, EllipsoidCriterion criterion, double ratio,
                             Index k) {
  const double mu = (alpha + beta) / 2, h = (beta - alpha) / 2;
  const double B = (beyond(alpha) + beyond(beta)) / 2;
  double share = criterion == EllipsoidCriterion::trace
                     ? least_trace(mu, h, B, ratio)
                     : least_volume(mu, h, B, static_cast<double>(k));
  // h² keeps b² = B + h²/κ + μ²κ below 3
  share = std::isnan(share) ? 1 : std::clamp(share, h * h, 1.0);
  const double b_squared = B + h * h / share + mu * mu * share;
  SlabEllipsoid best{mu * (1 - share), std::sqrt(share * b_squared), std::sqrt(b_squared)};
  if (!(share < 1) || !(best.a < best.b)) return {};
  // For a < b the left-hand side of (t - m)²/a² + (1 - t²)/b² ≤ 1 is convex in t: the ends decide.
  double most = 0;
  for (const double end : {alpha, beta}) {
    const double off = (end - best.m) / best.a;
    most = std::max(most, off * off + beyond(end) / (best.b * best.b));
  }
  const double raise = std::sqrt(most) * (1 + 24 * unit);
  best.a *= raise;
  best.b *= raise;
  return best;
}

std::optional<Ellipsoid> cut(const Ellipsoid& X, const EllipsoidStrip& strip,
                             EllipsoidCriterion criterion, double margin) {
  require_size(strip.a.size(), X.dim(), "cut of an ellipsoid", "the strip's normal");
  const Vector g =
      X.L.cols() > 0 ? Vector(linalg::transposed_product(X.L, Matrix(strip.a))) : Vector(0);
  const double reach = g.size() ? length(g) : 0;
  const Interval centre = rounding::dot(strip.a, X.c);
  // everything that g, the rounding box and the strip leave open
  const double slack =
      (product_slack(X.L, strip.a) + weighted(strip.a, X.r) + strip.error) * enlarge;
  const double share = static_cast<double>(g.size() + 16) * unit;
  // bounds of gᵀu
  const double lower = rounding::down(rounding::down(strip.lower - centre.upper) - slack),
               upper = rounding::up(rounding::up(strip.upper - centre.lower) + slack);
  const double missed = std::max(lower, -upper);
  if (missed > reach * (1 + share)) {
    const double nearer = lower > -upper ? strip.lower : strip.upper;
    const double terms = weighted(strip.a, X.c.cwiseAbs()) + reach + std::abs(nearer);
    if (missed - reach * (1 + share) > margin * terms) return std::nullopt;
    return X;
  }
  if (!(reach > 0) || !std::isfinite(reach) || !std::isfinite(slack)) return X;
  const auto end = [&](double bound, double sign) {
    const double t = bound / reach;
    return std::clamp(t + sign * (std::abs(t) * share + rounding::tiny), -1.0, 1.0);
  };
  const Slab slab{end(lower, -1), end(upper, 1)};
  if ((slab.lower == -1 && slab.upper == 1) || !(slab.lower <= slab.upper)) return X;
  std::optional<Ellipsoid> result = shrunk(X, g, slab, criterion);
  if (!result || !result->c.allFinite() || !result->L.allFinite() || !result->r.allFinite())
    return X;
  // of a strip that is as thin as its own uncertainty the guards may outweigh the gain
  const bool worse = criterion == EllipsoidCriterion::trace &&
                     length(result->L.reshaped()) >= length(X.L.reshaped());
  return worse ? X : *std::move(result);
}

}  // namespace cordon::sets
