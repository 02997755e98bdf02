// SPDX-License-Identifier: GPL-3.0-or-later
// By how much the rounding errors of a run may move what it reports.
#pragma once

#include "cordon/interfaces/model.hpp"
#include "cordon/interfaces/observer.hpp"

namespace cordon::detail {

/// Per coordinate a bound τ_k of what nominal operations and the observer's own arithmetic may add
/// up to, from the recorded sets alone. With s_k, the magnitude of the terms that x_k is made of:
///   r_k = |c| + Σ|G| of X_k,   a_k = M (|A| r_{k-1} + |B||u_{k-1}| + |Bw| w) + N (|B||u_k| + |Bw|
///   w),   a_0 = |c| + Σ|G| of X_0, s_k = |T||T⁻¹| max(r_k, a_k), e_k = M |A| e_{k-1} + ε s_k + ε_t
///   t_k,   τ_k = min(e_k, 1e-9 P max_{j ≤ k} max(s_j, t_j)), P = Σ_{i<n} (M |A|)ⁱ
/// where a_k grows by (1 + l) |A M| t for l lines M of X_{k-1} that y_k cuts to lengths t = |(C A
/// M)⁺| |y_k|, and M = T = I, N = 0 without E, and else z = T⁻¹x the coordinates of
/// cordon/interfaces/semi_explicit.hpp, in which its observers work, M and N the magnitudes of what
/// solves dynamic and static rows for x_k; w the reach of W; and t_k,i the terms |y_k| + |D||u_k| +
/// |Dv| v of the outputs in which coordinate i has the largest coefficient, divided by it, and of
/// the others as far as X_k leaves it open. ε = ε_t
/// = 1e-13 for nominal rounding: a step is a product, a sum, a correction and a reduction, each of
/// which may cancel or add 1e-14 of its terms. With outward rounding the operations enclose, and
/// what is left is what observers compute from model and data before: ε = 1e-14, ε_t = 1e-15. A
/// bound of the size of rounding, not a proof: where e_k grows without limit, so does the error, up
/// to 1e-9 of the largest terms there were. Of a model by formulas τ_k = 1e-9 max_{j ≤ k} r_j.
class RoundingMargin {
 public:
  RoundingMargin(const Model& model, const LineForm& initial_set, Rounding rounding);

  /// τ_k. For every recorded step, in order; `before` is the sample of k-1, or null if X_{k-1} was
  /// not recorded.
  Vector next(const LineForm& X, const Sample* before, const Sample& now);

  /// Per output, 1e-13 of the terms of y_k = C x_k + D u_k + Dv v_k for the last step; x_k as far
  /// out along lines as without them. Of outputs that are missing, nothing is said.
  const Vector& of_outputs() const { return of_outputs_; }

 private:
  void take_paths();
  Vector forces(VectorIn u) const;
  Vector cut_lines(const Vector& data, const Sample& now) const;
  Vector left_open_by(const Vector& data, const LineForm& X) const;

  const LinearModel& model_;
  bool is_linear_;
  double of_a_step_, of_the_data_;  ///< ε, ε_t
  Vector initial_;                  ///< a_0
  Matrix dynamic_, static_;         ///< M, N
  Matrix mixed_;                    ///< |T||T⁻¹|
  Matrix lines_;                    ///< of X_{k-1}
  Matrix paths_;  ///< Σ (M|A|)ʲ, j < n: how far errors of one state reach others
  Vector disturbance_, noise_;
  Vector reach_, error_, largest_, of_outputs_;
};

}  // namespace cordon::detail
