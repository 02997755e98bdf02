// SPDX-License-Identifier: GPL-3.0-or-later
// Room for the rounding errors of vectors that an observer adds up before a backend sees them.
#pragma once

#include <vector>

#include "cordon/interfaces/backend.hpp"

namespace cordon::estimators {

/// How thick Z = {N ξ : ‖ξ‖∞ ≤ 1} is, the sum of the disturbances of a step. What is wide in every
/// coordinate may be flat all the same, as a disturbance that acts on two states alike is across.
class Thickness {
 public:
  Thickness() = default;  ///< of {0}
  explicit Thickness(const Matrix& N);
  /// Of {T x : x ∈ X}; taken for {0} where X has constraints, which may leave as little of it.
  Thickness(const LineForm& X, MatrixIn T);

  /// A σ with {x : |x_i| ≤ r_i} ⊆ σ Z, about the smallest; ∞: there is none.
  double share_of(VectorIn r) const;
  /// No r with entries up to 1 has a larger share.
  double largest_share() const { return largest_; }
  /// The same of these coordinates alone.
  Thickness of_rows(const std::vector<Index>& rows) const;

 private:
  Matrix shares_;  ///< |N⁺|; columns of coordinates that N does not reach alone are infinite
  double largest_ = infinity;
};

/// A vector of products and sums that cancel, y - D u or B u, is off by rounding errors of its
/// terms, however small it is. A backend of nominal rounding sees what is left alone, and a set
/// that is thinner than these errors would lose the truth: a box of 1e-14 of the terms makes room
/// for them. None where nothing cancels (the sum is a quarter of its terms or more, so that its own
/// last digits are as large), where the set holds the box 1e10 times as wide, and for backends that
/// round outward: these take the products as sets.
class RoundingRoom {
 public:
  /// Per row `sum`, and the magnitudes of its terms added up; `thickness` of the set that it is the
  /// center of.
  RoundingRoom(const SetBackend& backend, VectorIn sum, VectorIn terms, const Thickness& thickness);

  /// The same in every row, whatever the sum and the set are, and for every backend. Rows of
  /// infinite terms are free, where the backend has unbounded sets.
  RoundingRoom(const SetBackend& backend, VectorIn terms);

  /// Can any row need room whose terms add up to `most`? At no cost.
  static bool may_be_needed(double most, const Thickness& thickness);
  /// The same of rows by their own terms.
  static bool may_be_needed(VectorIn terms, const Thickness& thickness);

  bool is_needed() const { return columns_.cols() > 0; }
  /// The box, to be added to what is predicted. Lives as long as the room.
  Term term() const { return {columns_, factors_}; }
  Vector half_widths() const { return half_widths_; }
  /// {x ∈ X : z - C x ∈ T V}, with room in its rows.
  Enclosure correct(const Enclosure& X, const CorrectionArgs& measurement) const;

 private:
  void make(const RecycledVector<Index>& rows, VectorIn terms);

  const SetBackend& backend_;
  Matrix columns_;
  Enclosure factors_;
  Vector half_widths_;
};

/// A box around a set: exact where the set has neither constraints nor lines; else around it
/// without its constraints, with infinite sides along lines. At little cost.
Box reach_of(const Set& X);

/// Is 0 outside the box by more than rounding, which is a share of these sizes?
bool excludes_zero(const Box& box, VectorIn sizes);

/// The largest sum of magnitudes of a row.
double row_norm(const Matrix& A);

/// The columns of {T x : x ∈ X}, lines 1e8 times as long as its largest entry; none where X has
/// constraints.
Matrix columns_of(const LineForm& X, MatrixIn T);

}  // namespace cordon::estimators
