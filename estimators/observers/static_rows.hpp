// SPDX-License-Identifier: GPL-3.0-or-later
// A descriptor system in coordinates that part its dynamic rows from its static ones. [Rego2025, sec. 4]
#pragma once

#include "cordon/core/linalg.hpp"
#include "cordon/interfaces/model.hpp"

namespace cordon::estimators {

/// The system in the coordinates z = Vᵀ x: dynamic rows above, static rows below. With E = U Σ Vᵀ, n_z = rank E:
///   z̃_k = Ã z_{k-1} + B̃ u_{k-1} + B̃w w_{k-1},   0 = Ǎ z_k + B̌ u_k + B̌w w_k
/// A model without E has dynamic rows only.
struct StaticRows {
  Matrix T;                              ///< x = T z
  Matrix A, B, Bw;                       ///< dynamic rows, n_z of them, divided by the singular values
  Matrix static_A, static_B, static_Bw;  ///< static rows
  Matrix rows, static_rows_map;          ///< what makes the dynamic and the static rows of those of the model
  Matrix free_part;                      ///< [0; I]: where ž enters
  Vector sigma;                          ///< singular values of the scaled E

  bool is_exact = true;  ///< nothing was rounded: T = I, and equations were scaled by powers of two at most

  explicit StaticRows(const LinearModel& model);

  Index rank() const { return A.rows(); }
  Index static_rows() const { return static_A.rows(); }

  /// Does a factor of W enter dynamic and static rows alike? Constraints couple all factors.
  bool share_disturbances(const LineForm& W) const;
};

}  // namespace cordon::estimators
