// SPDX-License-Identifier: GPL-3.0-or-later
// Modes by hand, the published inputs, and outcomes of designs that are to be verified.
#pragma once

#include <string>
#include <utility>

#include <doctest/doctest.h>

#include "cordon/study/design.hpp"
#include "input_design/systems.hpp"

namespace verify_test {

using namespace cordon;

/// x⁺ = a x + u + w, y = x + v with |w|, |v| ≤ bound and any x_0.
inline Mode scalar(double a, double bound) {
  Mode mode;
  mode.name = "a = " + std::to_string(a);
  LinearModel& m = mode.model.linear;
  m.A = Matrix{{a}};
  m.B = m.Bw = m.C = m.Dv = Matrix::Identity(1, 1);
  m.D = Matrix::Zero(1, 1);
  mode.model.X0 = make_space(1);
  mode.model.W = mode.model.V = make_box({Vector{{-bound}}, Vector{{bound}}});
  return mode;
}

/// y = ± u + v, |v| ≤ 1: κ = |u| - 1.
inline ModeBank signs() {
  ModeBank bank{{scalar(0, 1), scalar(0, 1)}, 0};
  for (Mode& mode : bank.modes) mode.model.linear.C.setZero();
  bank.modes[0].model.linear.D(0, 0) = 1;
  bank.modes[1].model.linear.D(0, 0) = -1;
  return bank;
}

inline DesignOutcome given(Matrix u) {
  DesignOutcome outcome;
  outcome.status = DesignStatus::given;
  outcome.horizon = u.rows() - 1;
  outcome.best.emplace().u = std::move(u);
  return outcome;
}

inline void check_tubes(const ExactSeparation& found, Answer empty) {
  for (const Answer answer : found.empty) CHECK(answer == empty);
}

/// Inputs by time, stacked, as rows.
inline Matrix rows_of(const Vector& u, Index inputs) {
  return u.reshaped(inputs, u.size() / inputs).transpose();
}

inline const Matrix by_lines = rows_of(examples::published_line_input(), 2);
inline const Matrix by_constrained = rows_of(examples::published_constrained_input(), 2);

}  // namespace verify_test
