// SPDX-License-Identifier: GPL-3.0-or-later
// The states that model, bounds and data allow: what every reported set must contain.
#pragma once

#include <deque>
#include <optional>

#include "cordon/interfaces/descriptor_matrix.hpp"
#include "cordon/interfaces/model.hpp"
#include "cordon/solvers/polytope.hpp"

namespace cordon::verification {

/// F_k = {x_k : there are x_0 ∈ X_0, w_j ∈ W, v_j ∈ V with E x_{j+1} = A x_j + B u_j + Bw w_j, y_j
/// = C x_j + D u_j + Dv v_j, x_j ∈ X_A for all j ≤ k}; the equation of j = k, whose x_{k+1} is
/// free, restricts x_k by its static rows. Exact, by polyhedra in Rⁿ:
///   P_0 = X_0 ∩ X_A ∩ Y_0,   P_k = {x : E x ∈ A P_{k-1} ⊕ {B u_{k-1}} ⊕ Bw W} ∩ X_A ∩ Y_k,
///   F_k = {x ∈ P_k : A x + B u_k ∈ E Rⁿ ⊕ (-Bw W)},   Y_k = {x : y_k - D u_k - C x ∈ Dv V}.
/// E is that of DescriptorMatrix. Nothing is rounded from the numbers of model and data on, so that
/// F_k is the set itself, flat or not: no enclosure of it would do, since what lies in an enclosure
/// only refutes nothing. Numbers grow by some digits with every step that forgets nothing. Where A,
/// B and C are interval matrices, those of every step are drawn from them: F_k then holds some of
/// the consistent states, and is of use as long as it is not empty. Of several draws the first that
/// leaves a state is taken. Throws Errc::unsupported where polyhedra grow too large, in their
/// numbers of vertices or in their digits
/// (`most_bits`).
class FeasibleSets {
 public:
  FeasibleSets(const Model& model, const LineForm& initial_set,
               const std::optional<LineForm>& admissible_set);

  /// F_k for the next sample.
  Polytope step(const Sample& now);

  /// The states of F = F_k that later samples leave, too: of `samples`, the first is that of k. L_m
  /// is everything for the last of them, m, and
  ///   L_j = {x : A x + B u_j ∈ (L_{j+1} ∩ Y_{j+1}) ⊕ (-Bw W)},   F ∩ L_k.
  /// Of models without E whose matrices are exact.
  Polytope narrowed(const Polytope& F, const std::deque<Sample>& samples) const;

 private:
  Polytope reached(const LinearModel& m, const Sample& now) const;
  Polytope measured(const LinearModel& m, const Polytope& X, const Sample& now) const;

  Polytope next(const LinearModel& m) const;

  const LinearModel& model_;
  DescriptorMatrix E_;
  Polytope initial_;
  std::optional<Polytope> admissible_, P_;
  Polytope disturbance_, minus_disturbance_, minus_noise_;  ///< Bw W, -Bw W, -Dv V
  std::optional<Sample> before_;
};

inline constexpr std::size_t most_bits = std::size_t{1} << 22;  ///< of all numbers of one F_k

/// The model with A, B and C drawn from their intervals, by k and the number of the draw: close to
/// vertices, or in the middle for draw 1. Of exact and of descriptor models, the model itself.
LinearModel drawn(const LinearModel& model, Index k, int draw);

/// {x_k : x_{k-1} ∈ X_{k-1} is consistent with sample k-1, and x_k is a successor of it that is
/// consistent with sample k}: an exchange form whose rows hold the numbers of model and data as
/// they are, so that nothing is rounded. Without `before`: X ∩ X_A ∩ Y_k. As for F_k, static rows
/// of time k restrict x_k.
struct Transition {
  const Sample* before = nullptr;
  const Sample& now;
};
LineForm successors(const Model& model, const LineForm& X,
                    const std::optional<LineForm>& admissible_set, const Transition& transition);

/// The model with each output widened by `radius`, and X with each coordinate and constraint
/// widened by `part` of a share of its terms (`rounding_share`, 1e-13): what nominal operations may
/// make of them.
inline constexpr double rounding_share = 1e-13;
Model widened(Model model, const Vector& radius);
LineForm widened(LineForm X, double part);

}  // namespace cordon::verification
