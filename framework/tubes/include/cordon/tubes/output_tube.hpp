// SPDX-License-Identifier: GPL-3.0-or-later
// The outputs that a mode can show over a horizon, as a set that is affine in the inputs.
#pragma once

#include <optional>
#include <vector>

#include "cordon/core/line_form.hpp"
#include "cordon/interfaces/backend.hpp"
#include "cordon/interfaces/model.hpp"
#include "cordon/linearisation/along_trajectories.hpp"

namespace cordon {

/// Which outputs over which horizon.
struct TubeSpan {
  Index horizon = 1;              ///< N ≥ 0: inputs u_0 … u_N
  bool last_output_only = false;  ///< the outputs y_N [Scott2014]; else y_0 … y_N [Rego2025]
  /// X_A: x_k ∈ X_A is assumed for k ≥ 1, of which the part that E does not determine is used;
  /// nothing: not assumed.
  std::optional<LineForm> admissible_set = {};
};

/// Y(u) = {c + H u + Mδ + Gξ : ‖ξ‖∞ ≤ 1, Sδ + Aξ = b + Ω u}, the output reachable tube of one mode,
/// u = (u_0, …, u_N):
///   x_0 ∈ X0, w_k ∈ W, v_k ∈ V,   E x_{k+1} = A x_k + B u_k + Bw w_k for k = 0 … N,   y_k = C x_k
///   + D u_k + Dv v_k
/// with the states x_1 … x_{N+1} among the free δ, so that x_{N+1} leaves of the last equation what
/// does not hold E x_{N+1}: the static rows of k = N [Rego2025, sec. 5]. Exact; every coefficient
/// is a number of the model, a product of two, or a row of A or C times X0. Shapes: c, H, M, G have
/// n_y (N+1) rows by time (n_y if only the last output counts), H and Ω have n_u (N+1) columns.
struct OutputTube {
  Matrix M, G, H;
  Vector c;
  Matrix S, A, Omega;
  Vector b;
  bool is_exact = true;             ///< no product or sum was rounded
  Vector c_size = {}, b_size = {};  ///< of the terms that c, G and b, A were added up from: where
                                    ///< X0 lies far away in unlike coordinates, A x₀ cancels

  Index outputs() const { return c.size(); }
  Index inputs() const { return H.cols(); }
  /// The set for one input sequence.
  LineForm at(VectorIn u) const;
};

/// The tube with X0, W, V (and X_A) as `backend` expresses them; of a set that it can only enclose
/// as the model has it, for of a wider tube neither that it meets another one nor κ could be said.
/// Throws Errc::unsupported where the backend cannot even enclose. Of a model that changes with
/// time A, B, …, W and V are those of the time; E has to stay.
OutputTube output_tube(const TimedModel& model, const SetBackend& backend, const TubeSpan& span);

/// What rounding in the elimination of lines may have changed in a row, as a share of its terms.
inline constexpr double tube_row_noise = 2e-13;

/// The same set with the lines eliminated that constraints determine, as far as that is exact: no S
/// is left, and Ω u stands in those rows only that no line appears in. Every u leaves the tube
/// non-empty if no row is left, and none vanished.
struct TubeConditions {
  Matrix A, Omega;  ///< A ξ = b + Ω u, m rows: the tube under u is empty if and only if there is no
                    ///< such ‖ξ‖∞ ≤ 1
  Vector b;
  Vector magnitude;  ///< size of the terms that A ξ - b was computed from, ‖ξ‖∞ ≤ 1
  Matrix Omega_magnitude = {};  ///< likewise of Ω
  Index vanished = 0;           ///< rows that became 0 = 0 up to rounding, and are left out; 0 if
                                ///< all of them are shown to follow from the others

  /// Size of the terms of A ξ - b - Ω u for |u| ≤ `reach`.
  Vector terms(VectorIn reach) const;
};
TubeConditions conditions_of(const OutputTube& tube);

}  // namespace cordon
