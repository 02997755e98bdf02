// SPDX-License-Identifier: GPL-3.0-or-later
// The Luenberger recursion on sets, for one model and one gain. [Xu2014, (6)-(7), (13)-(14)]
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cordon/core/recycled.hpp"
#include "cordon/interfaces/archive.hpp"
#include "cordon/interfaces/backend.hpp"
#include "cordon/interfaces/model.hpp"
#include "observers/rounding_room.hpp"

namespace cordon::estimators {

/// For x⁺ = A x + B f u + Bw w, y = g (C x + D f u) + Dv v with f, g in diagonal ranges around f̄, ḡ
/// and A, B, C in interval matrices (A, B, C their centres from here on), and C̄ = ḡ C, D̄ = ḡ D:
///   X̂⁺ = (A - L C̄) X̂ ⊕ {L y + (B - L D̄) f̄ u} ⊕ P,   P = (B - L D̄) rad(f) diag(u) [-1,1]^p ⊕ (-L
///   Dv) V ⊕ Bw W ⊕ Π ⊕ (-L) Δ R   = {y - D̄ f̄ u} ⊕ (-C̄) X̂ ⊕ Q,                 Q = D̄ rad(f) diag(u)
///   [-1,1]^p ⊕ (-Dv) V ⊕ Δ
/// Π and Δ are boxes with the half widths rad(A) |x| + rad(B) |max f u| and rad(g) |C x + D f u| +
/// max g rad(C) |x|, x ∈ X̂; they are {0} for exact matrices and exactly known sensors. x ∈ X̂
/// implies x⁺ ∈ X̂⁺ and 0 ∈ R. A diag per input: a single column rad(f) u would tie the inputs to
/// each other. Where terms cancel, or the backend rounds outward, P has room for what A - L C̄, L Dv
/// and the sums have been rounded by (rounding_room.hpp); with outward rounding a coordinate of X̂⁺
/// is free where an entry of A - L C̄ was rounded that meets an unbounded coordinate of X̂. Models
/// with E are not taken. Constant functions may be used from several threads.
class LuenbergerRecursion {
 public:
  /// L is n×n_y. `held`: a zonotope by its columns (n rows, or none at all) of which every X̂ that
  /// is to come holds a translate; it only tells how thick X̂⁺ is. Throws Errc::dimension.
  LuenbergerRecursion(const Model& model, Matrix L, std::shared_ptr<const SetBackend> backend,
                      Budget budget, Matrix held = {});

  /// The gain from now on; n×n_y. Throws Errc::dimension.
  void use_gain(Matrix L);
  /// The same, as the first one.
  void start(Matrix L);
  /// What gains so far have left: how thick X̂⁺ is known to be, where `held` tells it. The gain is
  /// to be given anew.
  void serialize(Archive& archive);

  const SetBackend& backend() const { return *backend_; }

  /// X̂⁺ before reduction, from X̂ and the sample of the same time. `open`, if asked for: the half
  /// widths of the part of P that is not W or V, of no entries where there is none. The room for
  /// rounding is part of it. `hull`: that of X̂, where it is known already.
  Enclosure next(const Enclosure& X, const Sample& now, Vector* open = nullptr,
                 const Box* hull = nullptr) const;
  Enclosure reduced(const Enclosure& X) const { return backend_->reduce(X, budget_); }
  /// Half widths of Δ, infinite where X̂ has no bounds that an output needs; of no entries for exact
  /// sensors and C.
  Vector open_outputs(const Enclosure& X, VectorIn u) const;
  /// R, in the space of outputs.
  Enclosure residual(const Enclosure& X, const Sample& now) const;

  /// Of the errors x - x̂ around the point observer, e⁺ = F e + N ξ + …, ‖ξ‖∞ ≤ 1: F = A - L C̄, and
  /// N = [Bw G_W, -L Dv G_V].
  const Matrix& error_map() const { return Ao_; }
  Matrix error_noise() const;

  /// The point observer, centres in place of sets: the same numbers on every backend.
  Vector next(VectorIn x, const Sample& now) const;
  Vector residual(VectorIn x, const Sample& now) const;

  /// Sizes of the numbers that x̂⁺ and r are made of, before they cancel: (|A| + |L||C̄|) |x̂| + …,
  /// and |y| + … + |C̄| s for x̂ of size s. What rounding leaves in X̂⁺ and R is a share of them,
  /// however small these come out.
  Vector next_size(VectorIn x, const Sample& now) const;
  Vector residual_size(VectorIn s, const Sample& now) const;

  /// {C̄ e : some noise explains now.y if the state is x̂ + e}, e ∈ E needed for Δ: an enclosure of
  /// it.
  Enclosure explained_outputs(const Enclosure& E, VectorIn x, const Sample& now) const;
  /// {e ∈ E : C̄ e ∈ outputs}, or an enclosure of it: given λ (n×n_y), (I - λ C̄) E ⊕ λ outputs; else
  /// the backend's intersection.
  Enclosure errors_within(const Enclosure& E, const Enclosure& outputs,
                          const Matrix* strip_gain) const;

  /// Bounds of the matched error set {x} ⊕ (-X̂) and its residual: (A - L C̄) E ⊕ P ⊕ (-P) and C̄ E ⊕
  /// Q ⊕ (-Q), P and Q moved to the origin; X̂ is needed for Δ.
  Enclosure next_bound(const Enclosure& E, const Enclosure& X, const Sample& now) const;
  Enclosure residual_bound(const Enclosure& E, const Enclosure& X, const Sample& now) const;

 private:
  /// Summands T S that are made for one sample, and the terms that view them.
  struct Summands {
    Matrix inputs;
    Enclosure parameters, outputs;
    RecycledVector<Term> terms;
    Vector half_widths;  ///< of the sum; no entries: nothing is open
  };
  enum class Target { state, output };
  /// Adds what ranges and interval matrices leave open in X̂⁺ or in R.
  void add_open(Summands& to, Target target, const Enclosure& X, VectorIn u, bool twice) const;
  Vector output_widths(const Enclosure& X, const Vector& largest, VectorIn u) const;
  /// For X̂⁺, whose shift has been added up already.
  std::optional<RoundingRoom> room_of(const Enclosure& X, VectorIn shift, const Sample& now,
                                      const Box* hull) const;
  Vector lost_rows(const Box& reach) const;
  void take_sizes();
  void take_thickness();

  std::shared_ptr<const SetBackend> backend_;
  Budget budget_;
  Matrix L_, minus_L_, Ao_, A_, B_, C_, minus_C_, D_;  ///< C and D: C̄ and D̄
  Vector f_, most_f_;                                  ///< f̄, max f
  Matrix input_, output_input_;                        ///< (B - L D̄) f̄, D̄ f̄
  std::vector<Index> ranged_;                          ///< inputs with rad(f) > 0
  Vector ranged_radius_;                               ///< their radii
  Matrix ranges_, output_ranges_;  ///< their columns of (B - L D̄) rad(f) and D̄ rad(f)
  Matrix Bw_, minus_Bw_, Dv_, minus_Dv_, minus_LDv_;
  Matrix state_unit_, output_unit_;
  Enclosure W_, V_, W0_, V0_;               ///< W0, V0: moved by -w̄, -v̄
  Matrix W_generators_, V_generators_;      ///< of zonotopes around W and V
  Enclosure unit_;                          ///< [-1,1] to the power of `ranged_`
  Vector state_drift_, w_, v_;              ///< Bw w̄, Bw w̄ - L Dv v̄, Dv v̄
  Matrix x_terms_, y_terms_, u_terms_;      ///< |A| + |L||C̄|, |L|, (|B| + |L||D̄|) f̄
  Vector disturbance_terms_, noise_terms_;  ///< sizes of Bw W and Dv V
  Vector constant_terms_;                   ///< sizes of Bw W and L Dv V
  Thickness W_thickness_, thickness_;       ///< of Bw W; of Bw W ⊕ (-L Dv V), or as that of Bw W
  Matrix held_, thick_L_;                   ///< L for which `thickness_` was found, with `held_`
  Vector output_size_;                      ///< of C̄ held and Dv V
  double x_norm_ = 0, y_norm_ = 0, u_norm_ = 0, constant_norm_ = 0;
  Matrix raw_C_, raw_D_;                   ///< C and |D| max f, for Δ
  Vector sensor_radius_;                   ///< no entries: exact sensors
  Matrix A_radius_, B_radius_, C_radius_;  ///< 0×0: exact; of C: max g rad(C)
};

}  // namespace cordon::estimators
