// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of a pair of modes in units of their own size, and what multipliers of them prove.
#pragma once

#include "designers/separation_problem.hpp"

namespace cordon::designers {

/// The rows of a pair by powers of two at the size of their terms, so that 1 is the size of
/// everything, in the factors ζ of U.
struct ScaledPair {
  Matrix G, N;  ///< G ξ + c = N ζ
  Vector c;
  Vector terms;   ///< per row, for ‖ξ‖∞ ≤ 1 + ε and ‖ζ‖∞ ≤ 1
  Vector scale;   ///< per row: what those of the pair were multiplied by
  double factor;  ///< 1 + ε

  ScaledPair(const PairProgram& pair, const InputSequences& U, double epsilon);
};

/// A half-space of the factors ζ, ‖ζ‖∞ ≤ 1, of the input sequences U = {c + Gζ}. Largest |a_i|
/// is 1.
struct SeparatingFacet {
  Vector a;
  double out = 0;  ///< a·ζ ≥ out: κ ≥ ε by one Farkas vector of the pair, rounding included
  double in = 0;   ///< where a·ζ < in for every facet of the set, κ < ε
};

/// The half-space of ζ that multipliers y on the scaled rows prove: `out` farther by `distance` of
/// the terms, `in` nearer by `below` and by rounding.
SeparatingFacet facet_of(const ScaledPair& pair, const Vector& y, double distance = 0,
                         double below = 0);

}  // namespace cordon::designers
