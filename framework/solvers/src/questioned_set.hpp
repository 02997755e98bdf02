// SPDX-License-Identifier: GPL-3.0-or-later
// A set as questions see it: without its lines, as a program over its factors.
#pragma once

#include <optional>

#include "cordon/core/line_elimination.hpp"
#include "cordon/core/line_form.hpp"
#include "cordon/solvers/boxed_program.hpp"

namespace cordon {

/// The part of X in ξ alone: lines eliminated, directions with lines known.
struct Questioned {
  std::optional<LinesEliminated> eliminated;  ///< nothing: X had no lines
  const LineForm& X;
  BoxedProgram program;
  Vector gradient;            ///< Gᵀd
  BoxedProgram::Bound bound;  ///< of the last direction; their memory is used again

  /// `form` must outlive this; `magnitude` (may be empty) is the size of what cancelled in its b
  /// before.
  explicit Questioned(const LineForm& form, VectorIn magnitude = Vector(0));
  Questioned(const Questioned&) = delete;
  Questioned& operator=(const Questioned&) = delete;

  bool unbounded_along(VectorIn d) const;

  /// Of the set `whole` that was eliminated.
  double support(const LineForm& whole, VectorIn d, Certificate* why);
  /// Along ±e_i: the gradient is a row of G.
  double support_along_axis(const LineForm& whole, Index i, double sign, Certificate* why);

  /// `why` speaks of the rows and factors before the elimination.
  Answer is_empty(Certificate* why);
  /// A point that the solver takes for a solution; it proves nothing by itself.
  Certificate candidate();
  /// (δ, ξ) of the set before the elimination.
  Vector with_lines(const Vector& xi) const;

 private:
  static double beyond(const LineForm& whole, Certificate* why);
  double support_of_gradient(double at_center, double gradient_error, Certificate* why);
  double support_through_lines(const LineForm& whole, VectorIn d, Certificate* why);
  Certificate farkas(Certificate own) const;
  Certificate point(const Certificate& own) const;
};

}  // namespace cordon
