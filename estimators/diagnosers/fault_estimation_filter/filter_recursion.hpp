// SPDX-License-Identifier: GPL-3.0-or-later
// Gains and error sets of the fault estimation filter, from step to step. Nothing here depends on
// data. [Wang2017]
#pragma once

#include "cordon/interfaces/archive.hpp"
#include "diagnosers/fault_estimation_filter/filter_design.hpp"

namespace cordon::estimators {

/// Is the noise of a sample one value wherever it enters, or an independent one each time?
enum class NoiseCoupling { independent, shared };

struct FilterNoise {
  Matrix Dw, Dv;  ///< generators of Bw W in the equations of E x⁺, and of Dv V in those of y
};

/// What noise and the first state contribute to the error e = x - x̂, for the gain G_k = Φ M + Ḡ_k Ω
/// of the smallest ‖R_{k+1}‖_F:
///   R_{k+1} = [(TA - G_k C) R̄_k, T Dw, -G_k Dv, -N Dv],   R̄ = R reduced,   e ∈ <0, R>
///   Ḡ_k = L̃ S̃⁻¹,  L̃ = (TA - Φ M C) P Cᵀ Ωᵀ - Φ M V Ωᵀ,  S̃ = Ω (C P Cᵀ + V) Ωᵀ,  P = R̄ R̄ᵀ,  V = Dv
///   Dvᵀ
/// `independent`: a fault lies within ± the row sums of |[M C R̄, M Dv]|, as published; v(k) is in R̄
/// and in Dv, as if it were two. `shared`: e = a - N Dv v(k), where a does not depend on v(k):
///   A_{k+1} = [(TA - G_k C) Ā_k, T Dw, -((TA - G_k C) N + G_k) Dv],   a ∈ <0, A>,   row sums of
///   |[M C Ā, M (I - C N) Dv]|
/// with the same gains. At the first step a = e, and the last block is -G_0 Dv.
/// Reduction [Combastel2003]: the smallest columns become a box. Without reduction the gain stays
/// after `steps_of_gains` steps, so that there is a limit that can be told in advance; sets hold
/// for any gain. O(n² l) a step.
class FilterRecursion {
 public:
  /// `max_columns` of R̄ and Ā, n or more; 0: they are not reduced, and grow with each step.
  FilterRecursion(const FilterDesign& design, const LinearModel& model, FilterNoise noise,
                  Index max_columns, NoiseCoupling coupling);

  static constexpr Index steps_of_gains = 400;

  /// e(0) ∈ <0, H>.
  void start(const Matrix& H);
  /// From k to k + 1. Throws Errc::not_finite where the bounds have outgrown the numbers.
  void advance();

  /// After a first `start`.
  void serialize(Archive& archive);

  bool is_reduced() const { return max_columns_ > 0; }
  bool has_last_gain() const { return !is_reduced() && steps_ >= steps_of_gains; }
  const Matrix& gain() const { return G_; }    ///< G_k of the last `advance`
  Matrix error_map() const;                    ///< TA - G_k C; after a first `advance`
  Vector seen(const Matrix& errors) const;     ///< row sums of |M C errors|
  const Matrix& errors() const { return R_; }  ///< R̄
  const Matrix& seen_errors() const {
    return coupling_ == NoiseCoupling::shared ? A_ : R_;
  }                      ///< whose images are seen: Ā or R̄
  Matrix noise() const;  ///< what the next step adds to them; not of the first step
  const Matrix& output_map() const { return MC_; }        ///< M C
  const Vector& own_noise() const { return own_noise_; }  ///< what half widths have besides
  /// The same columns, bit by bit: with equal design and noise all steps to come are the same.
  bool is_same(const FilterRecursion& other) const;
  const Vector& half_widths() const {
    return half_width_;
  }  ///< of the faults that are bounded at this time

 private:
  void find_gain();
  Matrix independent_noise() const;
  Matrix shared_noise() const;
  void find_half_widths();
  void reduce(Matrix& columns) const;

  Index max_columns_ = 0;
  NoiseCoupling coupling_;
  Matrix C_, N_, Dv_;
  Matrix base_, base_gain_;  ///< TA - Φ M C, Φ M
  Matrix Omega_, Omega_C_;
  Matrix TDw_, NDv_;
  Matrix gain_noise_, rest_noise_;  ///< Φ M V Ωᵀ, Ω V Ωᵀ
  Matrix MC_;
  Vector own_noise_;  ///< row sums of |M Dv|, or of |M (I - C N) Dv|
  Matrix R_, A_;
  Matrix G_;
  Matrix image_, seen_, reduced_gain_;  ///< (TA - Φ M C) R̄, Ω C R̄, Ḡ
  Vector half_width_;
  Index steps_ = 0;  ///< since the start
};

/// For each fault a bound of its half widths at all times of the steady state, with a proof;
/// infinite where there is none.
///   reduced    the recursion is one of doubles, and so goes round in a circle in the end: it is
///   run until a state comes again,
///              bit by bit, and the bound is the largest half width of the circle. At most 50 000
///              steps.
///   unreduced  after `steps_of_gains` steps the error map Φ stays, and what follows is bounded by
///   the sum of its powers
///              (cordon/invariant/minimal.hpp): sup_t [h_{A_N}((Φᵗ)ᵀ r) + Σ_{s<t} h_E((Φˢ)ᵀ r)] for
///              the rows r of M C.
/// In both cases errors of any direction must be shown to die out, by the powers of Φ or of the
/// product of the circle's maps: what the run has not stirred up, rounding will.
Vector lasting_half_widths(FilterRecursion recursion, const Matrix& H);

}  // namespace cordon::estimators
