// SPDX-License-Identifier: GPL-3.0-or-later
// Coordinates in which the errors of a linearisation fill a small box.
#pragma once

#include <span>

#include "cordon/formulas/evaluator.hpp"

namespace cordon {

/// e_i = d_i + factors_i d_main for i ≠ main and e_main = d_main: errors e of the rows by what is
/// bounded, d. Without a main row d = e.
struct ErrorFrame {
  Index main = -1;
  Vector factors;  ///< 0 of the main row

  /// d_i = weights(i) · e.
  Vector weights(Index i) const;
  /// e = Σ columns(i) d_i.
  Vector column(Index i) const;
};

/// The errors F(z) - slopes z of all rows follow one of them where the same nonlinear term stands
/// in several rows. By `points` of the box the frame is chosen whose box is smallest; one
/// with a main row is worth it from half of the volume on. O(rows² points).
ErrorFrame choose_error_frame(formulas::Evaluator& evaluator, MatrixIn slopes,
                              std::span<const Interval> box, Index points);

}  // namespace cordon
