// SPDX-License-Identifier: GPL-3.0-or-later
// The inputs that do not separate a pair of modes, as a polytope seen through the few combinations
// of inputs that matter.
#pragma once

#include "designers/facets/scaled_pair.hpp"
#include "designers/watch.hpp"

namespace cordon::designers {

struct ForbiddenSet {
  enum class Kind {
    facets,     ///< whoever is beyond one of the facets separates, and nobody else
    separated,  ///< proven: every input separates
    never,      ///< proven: no input separates
    unknown     ///< a solver failed, the search was stopped, or there are too many facets
  };
  Kind kind = Kind::unknown;
  std::vector<SeparatingFacet> facets;
  bool flat = false;  ///< the set has no width in a direction: from there `out` keeps a distance,
                      ///< see forbidden_set
  std::string reason = {};    ///< for `never` and `unknown`, to follow "modes i and j: "
  std::int64_t programs = 0;  ///< linear programs solved
};

/// With R and L the range and left null space of N restricted to the inputs that U lets vary, Q =
/// {RᵀGξ + Rᵀc : LᵀGξ = -Lᵀc, ‖ξ‖∞ ≤ 1 + ε} is grown from points that attain its support in the
/// directions of the facets of what is known so far, until no support lies beyond its facet.
///
/// What is proven. The multipliers of a support give y = R h + L z on the rows of the pair, and κ ≥
/// ε wherever
///   yᵀ(N u - c) ≥ (1+ε) ‖Gᵀy‖₁:   `out`, with rounding errors bounded; neither the hull nor R and
///   L need to be exact for it.
/// `in` rests on the hull: the points that the facets pass through are basic solutions, each
/// checked to satisfy its rows to 1e-11. Of Q they are only near: where its rows may be moved by
/// `room` before it is empty, which is proven, a residual r (with the effects of inputs that are
/// too small to be told from rounding, and 1e-14 of the terms, by which the rows are rounded) costs
/// a share of r / (r + room) of its size at most. `in` lies below the hull by that, and by
/// `tube_row_noise` of the terms of the facet, more than what rounding (one roundoff of the terms
/// per operation) can add. So a relaxation by `in` misses no separating input, and the difference
/// out - in is part of the reported gap: it is large where the modes nearly differ without any
/// input.
///
/// Where Q is flat (no width up to 1e-9 of the terms), every input off it separates, however near:
/// there is no cheapest one. `out` then asks for a distance of 1e-6 of the terms, so that a proof
/// can succeed; `in` does not.
ForbiddenSet forbidden_set(const PairProgram& pair, const InputSequences& U, double epsilon,
                           Index max_facets, const Watch& watch);

}  // namespace cordon::designers
