// SPDX-License-Identifier: GPL-3.0-or-later
// Lower bounds of children without a linear program.
#pragma once

#include <vector>

#include "designers/facets/forbidden_set.hpp"

namespace cordon::designers {

/// Where each input follows a factor ζ_j of its own and the cost is a sum, cost(u) = Σ_j f_j(ζ_j),
/// every λ ≥ 0 proves
///   cost ≥ Σ_f λ_f in_f + Σ_j min{f_j(ζ) - s_j ζ : |ζ| ≤ 1},   s = Σ_f λ_f a_f
/// for inputs beyond the facets f. A child keeps the multipliers of its parent and adds the best
/// one for its own facet.
class FacetDual {
 public:
  explicit FacetDual(const SeparationProblem& problem);
  /// Is the cost of that kind? Equations of the input set and of the tubes are forgotten, which
  /// keeps the bounds valid.
  bool usable() const { return usable_; }

  /// What the bounds need to know of a parent.
  struct Parent {
    Vector s;
    double level = 0;  ///< Σ_f λ_f in_f
  };
  Parent parent(const std::vector<const SeparatingFacet*>& chosen,
                const std::vector<double>& multipliers) const;
  double bound(const Parent& parent, const SeparatingFacet& facet) const;

 private:
  double minimiser(Index j, double s) const;
  double slope(const Parent& parent, const SeparatingFacet& facet, double lambda) const;

  bool usable_ = true, quadratic_ = false;
  Vector weight_, centre_;  ///< f_j(ζ) = weight |ζ - centre| or weight (ζ - centre)²
  double constant_ = 0;     ///< of inputs that do not vary
};

}  // namespace cordon::designers
