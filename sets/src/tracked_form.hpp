// SPDX-License-Identifier: GPL-3.0-or-later
// Row operations on a set in exchange form that lose no point to rounding.
#pragma once

#include <vector>

#include "cordon/core/line_form.hpp"

namespace cordon::sets {

/// Rows of constraints and rows of the state over the same factors, each with a radius. For every
/// point of the set there are δ and ξ, ‖ξ‖∞ ≤ 1, with
///   |S_i δ + A_i ξ - b_i| ≤ r_i   and   |x_i - c_i - M_i δ - G_i ξ| ≤ r_i
/// for the coefficients as stored. Row operations keep this: what rounding changes in a coefficient
/// is multiplied by a factor of magnitude at most 1 and goes to the radius. That holds for factors
/// whose own bound is forgotten as well, as the points of the set meet it all the same.
class TrackedForm {
 public:
  explicit TrackedForm(LineForm X);

  Index rows() const { return X_.constraints(); }
  Index factors() const { return X_.generators(); }
  bool is_live(Index row) const { return live_[static_cast<std::size_t>(row)]; }
  bool has_lines(Index row) const { return X_.lines() > 0 && !X_.S.row(row).isZero(0); }
  double coefficient(Index row, Index col) const { return X_.A(row, col); }
  bool without_rounding() const { return row_radius_.isZero(0) && state_radius_.isZero(0); }
  /// The largest coefficient or right-hand side.
  double scale(Index row) const;

  void drop(Index row) { live_[static_cast<std::size_t>(row)] = false; }
  /// Subtracts from row i the multiple of `row` that makes its coefficient of ξ_col zero. No lines
  /// in `row`.
  void subtract(Index i, Index row, Index col);
  /// Solves `row` for ξ_col, puts it in everywhere and drops both.
  void eliminate(Index row, Index col);
  /// Of the live rows and the factors given, the pair with the largest coefficient relative to its
  /// row; false if all are zero.
  bool best_pivot(const std::vector<Index>& among_rows, const std::vector<Index>& among_factors,
                  Index& row, Index& col) const;
  /// Drops rows without lines that say nothing (0 = 0) or little: the radius exceeds 1e-9 of the
  /// coefficients, so that a pivot there would spread it, or the row cancelled to 1e-12 of its
  /// terms, where the caller's data may have been rounded.
  void drop_vague_rows();
  /// Factors are rescaled to what the rows leave of [-1,1]; false if they leave nothing: the set is
  /// proven empty.
  bool rescale();

  /// The live rows without lines, with radii left out: what proposals are made from. `row_of`,
  /// `factor_of` tell the places here.
  LineForm nominal(std::vector<Index>& row_of, std::vector<Index>& factor_of) const;
  /// The set: a slack column per row with a radius, an axis-parallel generator per coordinate with
  /// one.
  LineForm result() const;

 private:
  void subtract_multiple(Index i, Index row, double factor);
  void subtract_from_state(Index i, Index row, Index col);

  LineForm X_;
  Vector row_radius_, state_radius_;
  Vector row_terms_;  ///< largest number that took part in the row so far
  std::vector<bool> live_, free_;
};

/// X with errors covered: r_i of the constraints by slack columns, q_i of the state by
/// axis-parallel generators; zero radii add nothing. Errc::not_finite after an overflow.
LineForm with_radii(const LineForm& X, const Vector& row_radius, const Vector& state_radius);

}  // namespace cordon::sets
