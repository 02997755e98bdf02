// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/facets/facet_dual.hpp"

#include <algorithm>
#include <cmath>

namespace cordon::designers {

namespace {

constexpr double rounding_share = 1e-14;  ///< of the terms of a bound
constexpr int most_doublings = 60, halvings = 20;

}  // namespace

FacetDual::FacetDual(const SeparationProblem& problem) {
  const InputSequences& U = problem.U;
  const Cost& cost = problem.cost;
  quadratic_ = cost.kind == Cost::Kind::quadratic;
  const Matrix enters = (U.G.array() != 0).cast<double>();
  const double most =
      enters.size() ? std::max(enters.rowwise().sum().maxCoeff(), enters.colwise().sum().maxCoeff())
                    : 0;
  usable_ = cost.kind != Cost::Kind::norm_inf && most <= 1;
  if (!usable_) return;
  weight_ = centre_ = Vector::Zero(U.G.cols());
  for (Index i = 0; i < U.c.size(); ++i) {
    const double apart = cost.reference[i] - U.c[i];
    Index j = 0;
    const double radius = U.G.cols() ? U.G.row(i).cwiseAbs().maxCoeff(&j) : 0.0;
    if (radius == 0) {
      constant_ += cost.weights[i] * (quadratic_ ? apart * apart : std::abs(apart));
    } else {
      weight_[j] = cost.weights[i] * (quadratic_ ? radius * radius : radius);
      centre_[j] = apart / U.G(i, j);
    }
  }
}

double FacetDual::minimiser(Index j, double s) const {
  const double w = weight_[j];
  if (quadratic_ && w > 0) return std::clamp(centre_[j] + s / (2 * w), -1.0, 1.0);
  return std::abs(s) <= w ? std::clamp(centre_[j], -1.0, 1.0) : s > 0 ? 1 : -1;
}

FacetDual::Parent FacetDual::parent(const std::vector<const SeparatingFacet*>& chosen,
                                    const std::vector<double>& multipliers) const {
  Parent parent{Vector::Zero(weight_.size()), 0};
  for (std::size_t f = 0; f < chosen.size(); ++f) {
    parent.s += multipliers[f] * chosen[f]->a;
    parent.level += multipliers[f] * chosen[f]->in;
  }
  return parent;
}

/// Of the bound in λ, which is concave.
double FacetDual::slope(const Parent& parent, const SeparatingFacet& facet, double lambda) const {
  double slope = facet.in;
  for (Index j = 0; j < weight_.size(); ++j)
    slope -= facet.a[j] * minimiser(j, parent.s[j] + lambda * facet.a[j]);
  return slope;
}

double FacetDual::bound(const Parent& parent, const SeparatingFacet& facet) const {
  double low = 0, high = weight_.size() ? std::max(weight_.maxCoeff(), 1e-300) : 1;
  for (int k = 0; k < most_doublings && slope(parent, facet, high) > 0; ++k) {
    low = high;
    high *= 2;
  }
  for (int k = 0; k < halvings; ++k) {
    const double middle = (low + high) / 2;
    (slope(parent, facet, middle) > 0 ? low : high) = middle;
  }
  double bound = constant_ + parent.level + low * facet.in;
  double terms = constant_ + std::abs(parent.level) + std::abs(low * facet.in);
  for (Index j = 0; j < weight_.size(); ++j) {
    const double s = parent.s[j] + low * facet.a[j], at = minimiser(j, s),
                 apart = std::abs(at - centre_[j]);
    bound += weight_[j] * (quadratic_ ? apart * apart : apart) - s * at;
    const double reach = 1 + std::abs(centre_[j]);
    terms += weight_[j] * (quadratic_ ? reach * reach : reach) + std::abs(parent.s[j]) +
             std::abs(low * facet.a[j]);
  }
  return bound - rounding_share * terms * static_cast<double>(weight_.size() + 4);
}

}  // namespace cordon::designers
