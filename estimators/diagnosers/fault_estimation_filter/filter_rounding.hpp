// SPDX-License-Identifier: GPL-3.0-or-later
// What rounding has left in the state of the fault estimation filter. [Wang2017]
#pragma once

#include "diagnosers/fault_estimation_filter/filter_recursion.hpp"

namespace cordon::estimators {

/// The filter of doubles is not the one of the paper: T E + N C = I and (TA - G C) Ψ = 0 hold up to
/// rounding only, and every step rounds. With the numbers that it has, its error x - x̂ follows
///   e⁺ = (TA - G C) e + T F n + … + (I - T E - N C) x⁺ + δ,
/// where δ is at most 1e-14 of the terms of the step, and r holds M Υ n for n. What the last two
/// add is kept as generators, which go on by the same TA - G C, each as it is until so many steps
/// have passed that a box around all of them shrinks in as many: boxes made earlier would grow
/// though the filter is stable. The sizes of x⁺ and e are those of x̂, of the error sets and of the
/// faults that have been seen; a fault that shows later counts from then on.
class FilterRounding {
 public:
  /// One sample as the filter takes it.
  struct Input {
    Vector x;           ///< x̂
    Vector output;      ///< sizes of the terms of ỹ
    Vector fault_size;  ///< |r| and the half widths of the faults, without what rounding adds
  };

  FilterRounding(const FilterDesign& design, const LinearModel& model, const FilterNoise& noise);

  void start(const Input& first, const FilterRecursion& recursion);
  /// From k to k + 1, after the recursion; `constant` are the sizes of Bw w̄. O(n² l).
  void advance(const Input& next, const FilterRecursion& recursion, VectorIn u_size,
               VectorIn constant);
  /// What the bounds of the faults must be widened by for it: row sums of |M C generators|, and
  /// 1e-10 of the terms of r. It depends on the faults themselves, n ≤ |r| + h + slack(n): the
  /// least n that keeps to that. `settle` throws Errc::not_finite where rounding has a quarter of a
  /// fault's response or more.
  const Vector& slack() const { return slack_; }
  /// After a first `start`.
  void serialize(Archive& archive);

 private:
  void settle(Input input, const FilterRecursion& recursion, const Matrix& kept,
              const Vector& left);
  Vector step_size(const FilterRecursion& recursion, VectorIn u_size, VectorIn constant) const;

  Matrix T_size_, A_size_, B_size_, C_size_, N_size_, M_size_, MC_;
  Vector Dw_size_, Dv_size_;  ///< row sums
  Matrix defect_;             ///< of T E + N C = I
  Matrix fault_state_;        ///< n×q: what a fault of 1 can be in x until it shows
  Matrix TA_Psi_, Upsilon_;
  Matrix mixing_;  ///< of M Υ = I
  Matrix generators_;
  Index steps_ = 1;  ///< that generators are kept for
  Input now_;
  Vector error_size_, size_, slack_;
  Matrix by_faults_;  ///< how the slack depends on n
};

}  // namespace cordon::estimators
