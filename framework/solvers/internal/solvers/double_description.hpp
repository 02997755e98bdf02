// SPDX-License-Identifier: GPL-3.0-or-later
// From inequalities to generators and back: the double-description method on integers [Fukuda1996].
#pragma once

#include <optional>
#include <vector>

#include "solvers/rational.hpp"

namespace cordon {

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

/// Minimal generators of {x : inequalities}: no rows for ∅, (1) alone for n = 0. Points and rays
/// are determined up to lines. Both conversions: Errc::unsupported above `most_dimensions` or
/// `most_rows`, and when `most_rays` intermediate ones or `most_work` operations are exceeded,
/// which takes seconds.
Description generators_of(const Description& inequalities);

/// Minimal inequalities of conv(points) ⊕ cone(rays) ⊕ span(lines). ∅ (no rows) gives the one row
/// -1 ≥ 0.
Description inequalities_of(const Description& generators);

/// The answer, and what was converted without redundancy (told as the conversion back), where that
/// follows: not of linear rows, of ∅, nor where rows imply equations or generators imply lines.
struct Conversion {
  Description answer;
  std::optional<Description> needed = std::nullopt;
};
Conversion generators_and_rows(const Description& inequalities);
Conversion inequalities_and_points(const Description& generators);

inline constexpr Index most_dimensions = 20;
inline constexpr std::size_t most_rows = 20'000, most_rays = 20'000;
inline constexpr double most_work = 4e8;  ///< on words, of bit sets and of numbers

}  // namespace cordon
