// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/strip.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/rounding.hpp"
#include "cordon/core/tolerances.hpp"
#include "require.hpp"
#include "residue.hpp"
#include "strip_gain.hpp"

namespace cordon::sets {

namespace {

/// Accumulated rounding errors of a nominal set, relative to its size: less is no proof of
/// emptiness.

/// A zonotope that is known up to rounding errors, coordinate by coordinate.
struct Computed {
  Zonotope Z;
  Vector noise;
};

struct Strip {
  double d, sigma;  ///< |ρᵀx - d| ≤ σ
  double terms;     ///< size of what d was computed from
};

/// aᵀb with its rounding error; exactly 0 if every term is.
Interval dot(VectorIn a, VectorIn b) {
  return (a.array() * b.array() != 0).any() ? rounding::dot(a, b) : Interval{0, 0};
}

/// Z(λ); the generators that vanish up to rounding (those parallel to λ, where ρᵀλ = 1) are
/// dropped.
Zonotope member_of_family(const Zonotope& Z, VectorIn rho, double shift, double sigma,
                          const Vector& lambda) {
  Matrix G(Z.dim(), Z.generators() + 1);
  for (Index j = 0; j < Z.generators(); ++j) {
    const auto g = Z.G.col(j);
    G.col(j) = g - lambda * rho.dot(g);
    const double level = 16 * rounding::unit * rho.cwiseAbs().dot(g.cwiseAbs());
    if ((G.col(j).array().abs() <= lambda.array().abs() * level).all()) G.col(j).setZero();
  }
  G.rightCols(1) = sigma * lambda;
  return drop_zero_generators(Zonotope{Z.c + lambda * shift, std::move(G)});
}

/// Puts Z(λ) in place of Z; false if the intersection is proven empty. The errors of every ρᵀg are
/// multiplied by λ: they widen the strip. So does the noise of the coordinates, which this
/// operation increases.
bool intersect(Computed& X, VectorIn rho, Strip strip, StripMethod method) {
  const Zonotope& Z = X.Z;
  const Interval middle = dot(rho, Z.c);
  const double spread =
      Z.generators() == 0 ? 0.0 : rounding::residual_norm_1(Vector::Zero(Z.generators()), Z.G, rho);
  const double lowest = rounding::down(middle.lower - spread),
               highest = rounding::up(middle.upper + spread);
  const double lower = rounding::down(strip.d - strip.sigma),
               upper = rounding::up(strip.d + strip.sigma);
  Vector sizes;
  take_reach(Z.c, Z.G, sizes);
  const double seen = rho.cwiseAbs().dot(sizes);  // what cancels in ρᵀG included
  const double margin = tolerances::proof_margin * (strip.terms + seen);
  if (lowest - upper > margin || lower - highest > margin) return false;
  if (lower <= lowest && highest <= upper) return true;
  double d = strip.d, sigma = strip.sigma;
  // The strip is narrowed to what Z meets of it: the same intersection, a better enclosure.
  if (lowest > lower || highest < upper) {
    const double low = std::max(lower, lowest), high = std::min(upper, highest);
    d = low / 2 + high / 2;
    sigma = rounding::up(std::abs(high / 2 - low / 2));
  }
  // d - ρᵀc cancels where Z is far from 0; what is lost there widens the strip.
  const Interval difference = middle.lower == middle.upper
                                  ? Interval{d - middle.lower, d - middle.lower}
                                  : rounding::subtract({d, d}, middle);
  const double shift = difference.lower / 2 + difference.upper / 2;
  sigma += difference.upper / 2 - difference.lower / 2;
  sigma += rounding::gamma(Z.dim() + 1) * seen + rho.cwiseAbs().dot(X.noise);
  const Vector lambda = strip_gain(Z.G, rho, sigma, method);
  if (lambda.isZero(0) || !lambda.allFinite()) return true;
  X.noise += tolerances::product_noise * (sizes + lambda.cwiseAbs() * (std::abs(shift) + seen));
  X.Z = member_of_family(Z, rho, shift, sigma, lambda);
  return true;
}

}  // namespace

std::optional<Zonotope> intersect_strip(const Zonotope& Z, VectorIn rho, double d, double sigma,
                                        StripMethod method) {
  constexpr const char* name = "strip intersection";
  check(Z, name);
  require_size(rho.size(), Z.dim(), name, "the normal");
  require_finite(rho, name, "the normal");
  require_finite(d, name, "the offset");
  require_finite(sigma, name, "the half width");
  if (sigma < 0)
    throw Error(Errc::invalid,
                "strip intersection: the half width is negative; it must be at least 0");
  Computed X{Z, Vector::Zero(Z.dim())};
  if (!intersect(X, rho, {d, sigma, std::abs(d)}, method)) return std::nullopt;
  return std::move(X.Z);
}

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
  Computed X{Z, Vector::Zero(Z.dim())};
  for (Index i = 0; i < C.rows(); ++i) {
    const Vector row = T.row(i);
    double d = z[i], sigma = 0;
    if (V.generators() > 0 && !row.isZero(0))
      sigma = rounding::residual_norm_1(Vector::Zero(V.generators()), V.G, row);
    if (const Interval middle = dot(row, V.c); middle.lower < middle.upper) {
      const Interval offset = rounding::subtract({z[i], z[i]}, middle);
      d = offset.lower / 2 + offset.upper / 2;
      sigma = rounding::up(sigma + rounding::up(std::max(offset.upper - d, d - offset.lower)));
    }
    const double terms = std::abs(z[i]) + row.cwiseAbs().dot(V.c.cwiseAbs()) + sigma;
    if (!intersect(X, C.row(i).transpose(), {d, sigma, terms}, method)) return std::nullopt;
  }
  return with_residue(std::move(X.Z), X.noise / tolerances::product_noise);
}

}  // namespace cordon::sets
