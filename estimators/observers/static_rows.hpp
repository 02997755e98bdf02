// SPDX-License-Identifier: GPL-3.0-or-later
// A descriptor system in coordinates that part its dynamic rows from its static ones. [Rego2025,
// sec. 4]
#pragma once

#include "cordon/interfaces/model.hpp"

namespace cordon::estimators {

/// The system in the coordinates z = T⁻¹ x of cordon/interfaces/semi_explicit.hpp, n_z = rank E:
///   z̃_k = Ã z_{k-1} + B̃ u_{k-1} + B̃w w_{k-1},   0 = Ǎ z_k + B̌ u_k + B̌w w_k
/// A model without E has dynamic rows only. Any coordinates in which z̃ is what E x determines give
/// the same sets; those of the singular values, which the source takes, mix states of unlike units.
///
/// With `keep_states` the states keep their coordinates, T = I, and the rows of E that are pivots
/// stay what they are,
///   Ẽ x_k = Ã x_{k-1} + B̃ u_{k-1} + B̃w w_{k-1},
/// so that of the dynamic rows no number is rounded.
struct StaticRows {
  Matrix T, T_inverse;  ///< x = T z, z = T⁻¹ x
  Matrix E;             ///< Ẽ; 0×0 where z̃ is given as it stands
  Matrix A, B, Bw;      ///< dynamic rows, n_z of them
  Matrix static_A, static_B,
      static_Bw;  ///< static rows, scaled by powers of two to entries of about 1
  Matrix rows,
      static_rows_map;  ///< what makes the dynamic and the static rows of those of the model
  Matrix free_part;     ///< [0; I]: where ž enters
  Matrix C;             ///< C T: the outputs are C T z

  bool is_exact = true;       ///< no number was rounded, but perhaps of C T
  bool static_exact = true;   ///< none of the static rows
  bool outputs_exact = true;  ///< none of C T

  explicit StaticRows(const LinearModel& model, bool keep_states = false);

  Index rank() const { return A.rows(); }
  Index static_rows() const { return static_A.rows(); }

  /// Does a factor of W enter dynamic and static rows alike? Constraints couple all factors.
  bool share_disturbances(const LineForm& W) const;
};

}  // namespace cordon::estimators
