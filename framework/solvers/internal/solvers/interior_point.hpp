// SPDX-License-Identifier: GPL-3.0-or-later
// An interior-point method for programs of many rows, where a simplex method walks past thousands
// of corners.
#pragma once

#include <utility>
#include <vector>

#include "cordon/core/types.hpp"

namespace cordon {

/// max{gᵀξ : Aξ = b, ‖ξ‖∞ ≤ 1} by proposals, as BoxSimplex makes them: Mehrotra's predictor and
/// corrector on the normal equations A D⁻¹ Aᵀ Δy = r, D = z⁺/(1 - ξ) + z⁻/(1 + ξ) [Mehrotra1992].
/// Some twenty rounds whatever the program's size; the bound of the multipliers exceeds the optimum
/// by some 1e-9 of it. Rows and objective should have entries of about 1. O(m² g + m³) per round,
/// less where columns begin below the first row or have one entry only.
class InteriorPoint {
 public:
  InteriorPoint(const Matrix& A, VectorIn b);

  /// False: the rounds did not end within the tolerance, because P is empty or flat, or for want of
  /// digits.
  bool maximize(VectorIn g);

  const Vector& multipliers() const { return y_; }
  const Vector& point() const { return xi_; }
  double value() const { return value_; }
  /// A score per column, the smaller the more likely off its bounds.
  const Vector& scores() const { return D_; }

 private:
  /// Columns of one group begin at the same row or below.
  struct Group {
    Index row, first, count;
  };
  struct Direction {
    Vector xi, y, above, below;
  };

  void arrange();
  bool factor();
  void solve_normal(Vector& v) const;
  void solve(const Vector& rest_above, const Vector& rest_below, Direction& step) const;
  std::pair<double, double> lengths(const Direction& step) const;
  double centrality() const;
  double centrality_after(const Direction& step) const;

  Matrix A_, sorted_;  ///< rows as given; columns with two entries and more, by their first ones
  Vector b_;
  std::vector<Index> order_;  ///< columns of `sorted_`
  std::vector<Group> groups_;
  struct Single {
    Index row, col;
  };
  std::vector<Single> singles_;        ///< columns of one entry
  Vector xi_, y_, above_, below_;      ///< ξ, y, z⁺, z⁻
  Vector to_upper_, to_lower_;         ///< 1 - ξ, 1 + ξ
  Vector D_, rows_left_, costs_left_;  ///< D, b - Aξ, g - Aᵀy - z⁺ + z⁻
  Matrix scaled_, normal_, factor_;
  double value_ = 0;
};

}  // namespace cordon
