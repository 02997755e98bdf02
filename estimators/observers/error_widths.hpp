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
class ErrorWidths {
 public:
  ErrorWidths(Rounded M, Rounded D);

  void start(const Rounded& R);
  void step();
  /// A step by other matrices; what follows starts from the box around the errors.
  void step_by(const Rounded& M, const Rounded& D);
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
  };
  void keep(State& state) const;
  void go_back(const State& state);

 private:
  Columns columns(const Rounded& Z) const;
  void add_sum_of(const Columns& Z, Vector& to) const;
  void move_on(Columns& Z) const;
  void forget(Columns& Z) const;

  Rounded M_, D_;
  ErrorMemory memory_;  ///< of M, at its beginning
  Matrix size_;         ///< |M|
  double tail_;         ///< Σ_j ‖Mʲ‖∞ at most; infinite: not known
  Columns noise_, start_;
  Vector sum_;  ///< Σ_{j<k} |Mʲ D| 1
  double steps_ = 0;
};

}  // namespace cordon::estimators
