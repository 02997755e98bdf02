// SPDX-License-Identifier: GPL-3.0-or-later
// Can several modes show the same outputs under one input sequence? Rows and proofs without any
// rounding.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "cordon/core/answer.hpp"
#include "cordon/linearisation/along_trajectories.hpp"

namespace cordon::verification {

/// What is compared: the inputs u_0 … u_N, a row each, and what DesignOutcome says of outputs and
/// states.
struct Experiment {
  const Matrix& u;
  bool last_output_only = false;
  const std::optional<LineForm>& admissible_set;
};

/// The rows that the runs of all models satisfy at once: for k = 0 … N
///   E x_{k+1} = A x_k + B u_k + Bw w_k,   y_k = C x_k + D u_k + Dv v_k,   x_0 ∈ X0, w_k ∈ W, v_k ∈
///   V
/// of each, the matrices and sets those of time k, with the same u_k and, where outputs count, the
/// same y_k. Without E the equation of k = N says nothing and is left out. With an admissible set
/// X_A also x_k = a + Eᵀλ, a ∈ X_A, for k = 1 … N: the part of x_k that E does not determine is
/// that of a. A set of dimension 0, empty if and only if the models' outputs differ; of one model,
/// if and only if its tube is empty. Every entry is a number of the models; effectiveness that is
/// known exactly multiplies in rows of its own.
LineForm common_runs(std::span<const TimedModel* const> models, const Experiment& experiment);

/// The outputs of all times that count, one below the other, which a model can show under the
/// inputs, by the same rows.
LineForm output_tube(const TimedModel& model, const Experiment& experiment);

/// Is the set of such rows empty? `yes` by a Farkas vector y with bᵀy > ‖Aᵀy‖₁, `no` by a solution,
/// both exact. If `yes`, it is empty for all ‖ξ‖∞ < 1 + κ too, with `kappa_lower` ≤ κ, rounded
/// down.
struct ExactEmptiness {
  Answer empty = Answer::unknown;
  double kappa_lower = 0;
  std::string reason = {};  ///< if unknown
};
ExactEmptiness exact_emptiness(const LineForm& rows);

/// The same rows with ‖ξ‖∞ ≤ reach in place of 1: a factor of b on a line of its own, so that no
/// entry is rounded. Errc::invalid unless reach > 0.
LineForm with_reach(const LineForm& rows, double reach);

}  // namespace cordon::verification
