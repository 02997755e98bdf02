// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "cordon/sets/outward.hpp"
#include "error_free.hpp"
#include "require.hpp"
#include "strip_gain.hpp"
#include "tracked_form.hpp"

namespace cordon::sets::outward {

namespace {

/// Gaps below this share of their terms are no proof of emptiness: the data may have been rounded
/// by the caller.
constexpr double data_error = 1e-10;

/// The zonotope ⊕ the box of half widths `radius`.
struct Widened {
  Zonotope Z;
  Vector radius;
};

/// ρᵀx over a widened zonotope: middle ± r + Σ p_j ξ_j.
struct Seen {
  Tracked middle;
  Vector p;
  double r = 0;

  Seen(const Widened& X, VectorIn rho) : middle(tracked_dot(rho, X.Z.c)), p(X.Z.generators()) {
    for (Index j = 0; j < p.size(); ++j) {
      const Tracked part = tracked_dot(rho, X.Z.G.col(j));
      p[j] = part.value;
      r = plus_up(r, part.error);
    }
    for (Index i = 0; i < rho.size(); ++i) r = plus_up(r, times_up(std::abs(rho[i]), X.radius[i]));
  }
  double spread() const { return plus_up(rounding::norm_1(p).upper, plus_up(r, middle.error)); }
};

struct Strip {
  double d, sigma;  ///< |ρᵀx - d| ≤ σ
  double terms;     ///< size of what d was computed from
};

/// The strip z - C_i x ∈ T_i V.
Strip strip_of(double z, VectorIn row, const Zonotope& V) {
  Tracked d{z, 0};
  double sigma = 0, terms = std::abs(z);
  for (Index k = 0; k < row.size(); ++k) {
    d.subtract_product(row[k], V.c[k]);
    terms += std::abs(row[k] * V.c[k]);
  }
  for (Index j = 0; j < V.generators(); ++j)
    sigma = plus_up(sigma, tracked_dot(row, V.G.col(j)).magnitude());
  return {d.value, plus_up(sigma, d.error), terms};
}

/// Z(λ) = c + λ(d - ρᵀc) + (I - λρᵀ)Gξ + σλη, an enclosure for the λ that is stored; false if the
/// intersection is proven empty.
bool intersect(Widened& X, VectorIn rho, Strip strip, StripMethod method) {
  const Seen seen(X, rho);
  const double spread = seen.spread();
  const double lowest = rounding::down(seen.middle.value - spread),
               highest = rounding::up(seen.middle.value + spread);
  const double lower = rounding::down(strip.d - strip.sigma),
               upper = rounding::up(strip.d + strip.sigma);
  const double doubt =
      data_error * (strip.terms + strip.sigma + rho.cwiseAbs().dot(X.Z.c.cwiseAbs()) + spread);
  if (lowest - upper > doubt || lower - highest > doubt) return false;
  if (lower <= lowest && highest <= upper) return true;
  if (lowest > lower ||
      highest <
          upper) {  // the part of the strip that Z meets; they may cross by less than the doubt
    const double low = std::max(lower, lowest), high = std::min(upper, highest);
    strip.d = low / 2 + high / 2;
    strip.sigma =
        std::max({directed::plus(high, -strip.d).upper, directed::plus(strip.d, -low).upper,
                  directed::plus(low, -strip.d).upper, directed::plus(strip.d, -high).upper});
  }
  Tracked shift{strip.d, 0};
  shift.subtract(seen.middle.value);
  shift.widen(seen.middle.error);
  const double doubt_of_row = plus_up(seen.r, shift.error);
  const Vector lambda = strip_gain(X.Z.G, rho, plus_up(strip.sigma, doubt_of_row), method);
  if (lambda.isZero(0) || !lambda.allFinite()) return true;

  const Index n = X.Z.dim(), g = X.Z.generators();
  Matrix G(n, g + 1);
  for (Index i = 0; i < n; ++i) {
    double& radius = X.radius[i];
    radius = plus_up(radius, times_up(std::abs(lambda[i]), doubt_of_row));
    const auto store = [&](double& place, const Tracked& x) {
      place = x.value;
      radius = plus_up(radius, x.error);
    };
    Tracked center{X.Z.c[i], 0}, edge;
    center.add_product(lambda[i], shift.value);
    store(X.Z.c[i], center);
    edge.add_product(strip.sigma, lambda[i]);
    store(G(i, g), edge);
    for (Index j = 0; j < g; ++j) {
      Tracked entry{X.Z.G(i, j), 0};
      entry.subtract_product(lambda[i], seen.p[j]);
      store(G(i, j), entry);
    }
  }
  // Columns along λ vanish but for rounding (ρᵀλ = 1): what is left of them joins the radius.
  for (Index j = 0; j < g; ++j) {
    const double level = 16 * rounding::unit * rho.cwiseAbs().dot(X.Z.G.col(j).cwiseAbs());
    if (!(G.col(j).array().abs() <= lambda.array().abs() * level).all()) continue;
    for (Index i = 0; i < n; ++i) X.radius[i] = plus_up(X.radius[i], std::abs(G(i, j)));
    G.col(j).setZero();
  }
  X.Z = drop_zero_generators(Zonotope{X.Z.c, std::move(G)});
  return true;
}

}  // namespace

std::optional<Zonotope> correct(const Zonotope& Z, MatrixIn C, VectorIn z, MatrixIn T,
                                const Zonotope& V, StripMethod method) {
  constexpr const char* name = "correction of a zonotope";
  check(Z, name);
  check(V, name);
  require_map(C, Z.dim(), name, "C");
  require_map(T, V.dim(), name, "T");
  require_size(z.size(), C.rows(), name, "z");
  require_size(T.rows(), C.rows(), name, "the number of rows of T");
  require_finite(z, name, "z");
  Widened X{Z, Vector::Zero(Z.dim())};
  for (Index i = 0; i < C.rows(); ++i) {
    const Strip strip = strip_of(z[i], T.row(i).transpose(), V);
    if (!intersect(X, C.row(i).transpose(), strip, method)) return std::nullopt;
  }
  const LineForm result = with_radii(make_zonotope(X.Z.c, X.Z.G), Vector(0), X.radius);
  return Zonotope{result.c, result.G};
}

}  // namespace cordon::sets::outward
