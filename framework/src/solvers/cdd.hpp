// SPDX-License-Identifier: GPL-3.0-or-later
// Façade of cddlib: the double-description method over the rationals [Fukuda1996].
#pragma once

#include <vector>

#include "solvers/rational.hpp"

namespace cordon::cdd {

/// Rows of a polyhedron in Rⁿ, each of n + 1 numbers.
///   inequalities  (β, a): β + aᵀx ≥ 0, or = 0 where `linear`
///   generators    (1, v): a point; (0, r): a ray, or a line where `linear`
struct Description {
  Index dim = 0;
  std::vector<rational::RationalVector> rows;
  std::vector<bool> linear;

  void add(rational::RationalVector row, bool is_linear) {
    rows.push_back(std::move(row));
    linear.push_back(is_linear);
  }
};

/// Minimal generators of {x : inequalities}: no rows for ∅, (1, 0) alone for n = 0. Points and rays are determined up to lines.
/// Both: Errc::unsupported, before anything is computed, if n > max_dim or if the upper-bound theorem allows more than max_output
/// rows of output; Errc::solver if cddlib fails. Calls wait for each other.
Description generators(const Description& inequalities);

/// Minimal inequalities of conv(points) ⊕ cone(rays) ⊕ span(lines). ∅ (no rows) gives the one row -1 ≥ 0.
Description inequalities(const Description& generators);

inline constexpr Index max_dim = 14;
inline constexpr double max_output = 100'000;

}  // namespace cordon::cdd
