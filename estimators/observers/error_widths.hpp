// SPDX-License-Identifier: GPL-3.0-or-later
// The hull of all errors of an observer with one gain for all times, as if nothing were ever
// reduced. [Tang2019]
#pragma once

#include <optional>

#include "gains/gain_form.hpp"
#include "observers/error_memory.hpp"

namespace cordon::estimators {

/// Half widths of the interval hull of the errors e⁺ = M e ⊕ D [-1,1]^m, e₀ ∈ R [-1,1]^r:
///   |Mᵏ R| 1 + Σ_{j<k} |Mʲ D| 1,
/// for every matrix within the errors of M, D and R, the rounding of all products included: what
/// the columns Mʲ D are off by obeys the same recursion, and decays as they do. Columns that have
/// decayed are replaced by a bound of all that they still add. O(n² (m + r)) per step.
///
/// Steps by other matrices keep the directions of the errors: the columns Mʲ D so far are made
/// again, and go through these steps together with all others. Whenever they have doubled in
/// number, the smallest ones are replaced by the box around them, as many as add no more than 1/64
/// to any half width, and always down to 2048. A box turns and decays with the other columns, so
/// that errors which decay stay bounded, however often they are boxed. O(n² N) for a step with N
/// columns, and making columns again costs no more than the steps before did. Columns of a gap go
/// on in complete steps until they add 1/64 or less.
class ErrorWidths {
 public:
  ErrorWidths(Rounded M, Rounded D);

  void start(const Rounded& R);
  void step();
  /// A step by other matrices, of errors that are off by up to `off` (n) in each entry besides.
  void step_by(const Rounded& M, const Rounded& D, VectorIn off);
  Vector half_widths() const;
  void take_half_widths(Vector& into) const;
  /// A memory of M in which nothing has happened yet.
  const ErrorMemory& memory() const { return memory_; }

  /// Columns Mᵏ Z and a bound of what they are off by, added up over the columns.
  struct Columns {
    Matrix value;
    ErrorMemory off;
    Vector past;  ///< a bound for all times to come, once `value` has decayed
  };
  /// What changes from step to step.
  struct State {
    std::optional<Columns> noise, start;
    Vector sum;
    double steps = 0;
    bool is_after_gap = false;
    Index limit = 0;
  };
  void keep(State& state) const;
  void go_back(const State& state);
  void serialize(Archive& archive);
  void serialize(State& state, Archive& archive) const;

 private:
  Columns columns(const Rounded& Z) const;
  void add_sum_of(const Columns& Z, Vector& to) const;
  void move_on(Columns& Z) const;
  void forget(Columns& Z) const;
  void end_gap();
  Matrix gathered(Vector& box) const;
  /// Up to so many columns nothing is boxed.
  Index fewest_boxed() const { return 4 * (D_.value.rows() + D_.value.cols()); }

  Rounded M_, D_;
  ErrorMemory memory_;     ///< of M, at its beginning
  Matrix size_;            ///< |M|
  double tail_;            ///< Σ_j ‖Mʲ‖∞ at most; infinite: not known
  Columns noise_, start_;  ///< Mᵏ D, and all that is not noise since the last gap
  Vector sum_;             ///< Σ_{j<k} |Mʲ D| 1
  double steps_ = 0;
  bool is_after_gap_ = false;  ///< are start_'s columns what a gap has left?
  Index limit_;                ///< of columns at a gap, before some are boxed
};

}  // namespace cordon::estimators
