// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "solvers/rational.hpp"
#include "study/verification/trajectory_program.hpp"

namespace cordon::verification {

/// Multipliers y of rows, and c - yᵀA for the objective cᵀx, as rational numbers.
class TrajectoryProof {
 public:
  /// c = 0, or c_j = sign.
  TrajectoryProof(const TrajectoryProgram& program, VectorIn multipliers, Index column,
                  double sign);

  /// cᵀx ≥ this for all x of the program; nothing where a column without a bound has a part in it.
  std::optional<rational::Rational> least() const;
  /// Moves multipliers so that states have no part in it where their bounds are too wide to be of
  /// use. False: some have one still.
  bool leaves_out_states();

 private:
  using Rational = rational::Rational;

  void move(Index row, const Rational& by);
  bool is_open(Index column) const;
  bool follow_states();
  bool close(const TrajectoryProgram::States& first);
  rational::RationalVector influence(std::size_t stage, Index output) const;

  const TrajectoryProgram& program_;
  std::vector<std::vector<std::size_t>> entries_of_row_;
  rational::RationalVector multipliers_, left_;
};

}  // namespace cordon::verification
