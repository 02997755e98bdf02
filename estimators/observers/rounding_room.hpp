// SPDX-License-Identifier: GPL-3.0-or-later
// Room for the rounding errors of vectors that an observer adds up before a backend sees them.
#pragma once

#include <vector>

#include "cordon/interfaces/backend.hpp"

namespace cordon::estimators {

/// A vector of products and sums that cancel, y - D u or B u, is off by rounding errors of its
/// terms, however small it is. A backend of nominal rounding sees what is left alone, and a set
/// that is thinner than these errors would lose the truth: a box of 1e-14 of the terms makes room
/// for them. None where nothing cancels (the sum is a quarter of its terms or more, so that its own
/// last digits are as large), where the row's set is 1e10 times as wide, and for backends that
/// round outward: these take the products as sets.
class RoundingRoom {
 public:
  /// Per row `sum`, the magnitudes of its terms added up, and the half width of the set that it is
  /// the center of (may be +inf).
  RoundingRoom(const SetBackend& backend, VectorIn sum, VectorIn terms, VectorIn half_widths);

  /// The same in every row, whatever the sum and the set are, and for every backend.
  RoundingRoom(const SetBackend& backend, VectorIn terms);

  /// Can any row need room whose terms add up to `most`, and whose set is no narrower than
  /// `least_width`? At no cost.
  static bool may_be_needed(double most, double least_width);

  bool is_needed() const { return columns_.cols() > 0; }
  /// The box, to be added to what is predicted. Lives as long as the room.
  Term term() const { return {columns_, factors_}; }
  Vector half_widths() const { return columns_.rowwise().sum(); }
  /// {x ∈ X : z - C x ∈ T V}, with room in its rows.
  Enclosure correct(const Enclosure& X, const CorrectionArgs& measurement) const;

 private:
  void make(const std::vector<Index>& rows, VectorIn terms);

  const SetBackend& backend_;
  Matrix columns_;
  Enclosure factors_;
};

/// A box around a set: exact where the set has neither constraints nor lines; else around it
/// without its constraints, with infinite sides along lines. At little cost.
Box reach_of(const Set& X);

/// The largest sum of magnitudes of a row.
double row_norm(const Matrix& A);

/// Half widths of {T x : x ∈ X} without its constraints; infinite along lines.
Vector half_widths(const LineForm& X, MatrixIn T);

}  // namespace cordon::estimators
