// SPDX-License-Identifier: GPL-3.0-or-later
// Interval matrices of modes as disturbances and noise of exact ones.
#pragma once

#include <vector>

#include "cordon/core/error.hpp"
#include "diagnosers/observer_bank/error_dynamics.hpp"
#include "diagnosers/observer_bank/fdi_conditions.hpp"

namespace cordon::estimators {

/// Modes with exact matrices, whose trajectories are those of the bank and more; or why there are
/// none, and the centres then.
struct ExactModes {
  ModeBank bank;
  std::vector<Diagnostic> problems = {};
};

/// With |x| ≤ X̄ at all times, whatever the modes are, and |u| ≤ Ū of the mode's U, what lies beside
/// the centres is bounded entrywise:
///   |ΔA x + ΔB f u| ≤ rad(A) X̄ + rad(B) Ū,   |g ΔC x| ≤ rad(C) X̄,
/// ΔA, ΔB and ΔC anew at every step. Boxes of these half widths, rounded up, stand beside W and V,
/// with columns of their own in Bw and Dv; modes without intervals stay as they are. X̄ is the hull
/// of options.state_set. Without one, all modes must have the same centre of A, which is Schur: X̄
/// then bounds the states of the modes that are made with X̄ itself, from `plant_starts` on, which
/// by induction over k bounds those of the bank. Where there is no X̄, the problem says so; inputs
/// without bounds are left to `check_offline`. Only options.state_set, initial_set and accuracy are
/// used. A system of the bank has no E.
ExactModes with_exact_matrices(const ModeBank& bank, const OfflineOptions& options);

}  // namespace cordon::estimators
