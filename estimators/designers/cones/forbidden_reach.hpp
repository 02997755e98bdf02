// SPDX-License-Identifier: GPL-3.0-or-later
// How far inputs may go in one direction before they separate a pair of modes.
#pragma once

#include <optional>

#include "designers/cones/star.hpp"
#include "designers/facets/scaled_pair.hpp"

namespace cordon::designers {

/// Of the inputs Q = {u : κ(u) < ε} that do not separate a pair, a convex set, what lies on rays
/// from a star's centre z in it.
class ForbiddenReach {
 public:
  /// Nothing where z is not proven to lie inside Q. `pair` and `star` have to stay.
  static std::optional<ForbiddenReach> of(const SeparationProblem& problem, const PairProgram& pair,
                                          const Star& star);

  struct Answer {
    double inverse = infinity;             ///< z + v/inverse is proven to lie in the closure of Q
    std::optional<SeparatingFacet> facet;  ///< of the factors of U: one that the ray leaves Q by,
                                           ///< near this point
  };
  /// Along z + θ v, for the largest θ. The rows of the solver's point are missed by some r,
  /// roundoffs of their terms included. Where those of z may be moved by `room` and be met all the
  /// same, which is proven, a share λ = r / (r + room) of z makes up for it: (1 - λ) θ is proven.
  Answer along(const Vector& v) const;
  /// κ keeps below ε within z ± s size, entry by entry, for 1/s this.
  double inverse_within(const Vector& size) const;

 private:
  ForbiddenReach(const PairProgram& pair, const Star& star, ScaledPair rows, Matrix G, Matrix N,
                 Vector c, Vector room)
      : pair_(&pair),
        star_(&star),
        rows_(std::move(rows)),
        G_(std::move(G)),
        N_(std::move(N)),
        c_(std::move(c)),
        room_(std::move(room)) {}

  const PairProgram* pair_;
  const Star* star_;
  ScaledPair rows_;
  Matrix G_, N_;  ///< G ξ = N v + c, ‖ξ‖∞ ≤ 1, with 1 + ε in G
  Vector c_;
  Vector room_;  ///< > 0
};

}  // namespace cordon::designers
