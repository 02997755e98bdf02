// SPDX-License-Identifier: GPL-3.0-or-later
// The linear plant of a simulation, step by step, with disturbances given from outside.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "cordon/core/box.hpp"
#include "cordon/interfaces/model.hpp"
#include "cordon/interfaces/semi_explicit.hpp"

namespace cordon::detail {

/// E x⁺ = A x + B u + Bw w, y = C x + D u + Dv v with E singular of index 1, regular, or the
/// identity. Additive faults n are further inputs: (u, n) and [B F] take the places of u and B from
/// here on, and the outputs do not show n.
///
/// In the coordinates z = T⁻¹x = (z̃, ž) of cordon/interfaces/semi_explicit.hpp:
///   z̃⁺ = Λ (A x + B u + Bw w)     (r dynamic rows)
///   0  = Σ (A x + B u + Bw w)     (n - r static rows; they hold at every k with the w of the same
///   k)
/// The static rows are solved for ž: Σ A Ť (Ť: columns of T of ž) must be regular, else the index
/// is above 1 and the constructor throws InputError. r = n: no static rows, any E of full rank. One
/// step is O(n (n + n_u + n_w + n_y)).
class LinearPlant {
 public:
  /// `pointer`: where the model stands in the study.
  LinearPlant(const LinearModel& model, const std::string& file,
              const std::string& pointer = "/system/E");

  /// Sets z̃_0 from a state; its static part is found by the first step.
  void start(VectorIn x0);
  /// x_0 is found from static rows, which may round it out of its set: coordinates that are outside
  /// these bounds by 1e-13 of the largest are put on them, and the static rows hold to rounding.
  void keep_first_in(Box bounds) { first_in_ = std::move(bounds); }
  /// Exchanges A, B and C; z̃ keeps its meaning, which depends on E only. Throws as the constructor
  /// does.
  void exchange(const Matrix& A, const Matrix& B, const Matrix& C);
  /// Goes on from z̃_k of a plant of the same E, whose z̃ means the same.
  void resume(const LinearPlant& other) { z_ = other.z_; }

  struct Output {
    Vector x, y;
  };
  /// x_k and y_k for the current k, then moves on to k + 1. u is what the actuators do, and n; the
  /// sensors show diag(sensor) (C x + D u).
  Output step(VectorIn u, VectorIn w, VectorIn v, VectorIn sensor);
  Output step(VectorIn u, VectorIn w, VectorIn v) {
    return step(u, w, v, Vector::Ones(model_.outputs()));
  }

  /// The state that belongs to z̃_k, u_k and w_k.
  Vector state(VectorIn u, VectorIn w) const;

  /// Static rows 0 = Ǎ x + B̌ u + B̌w w (in coordinates of x); no rows if E is regular.
  const Matrix& static_A() const { return static_A_; }
  const Matrix& static_B() const { return static_B_; }
  const Matrix& static_Bw() const { return static_Bw_; }

 private:
  void split_rows();
  void keep_in_bounds(Vector& x) const;

  LinearModel model_;  ///< with [B F] and [D 0]
  std::string file_, pointer_;
  SemiExplicitForm form_;
  Matrix dynamic_A_, dynamic_B_, dynamic_Bw_;  ///< Λ (A, B, Bw)
  Matrix static_A_, static_B_, static_Bw_;     ///< Σ (A, B, Bw), scaled by powers of two
  Matrix solve_;                               ///< -(Σ A Ť)⁻¹
  Vector z_;                                   ///< z̃_k
  std::optional<Box> first_in_;
};

/// Have both models the same E? Then the state of one can be carried over to the other.
bool same_descriptor(const LinearModel& a, const LinearModel& b);

}  // namespace cordon::detail
