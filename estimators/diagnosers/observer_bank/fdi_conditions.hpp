// SPDX-License-Identifier: GPL-3.0-or-later
// What a bank of Luenberger observers promises before any experiment. [Xu2014, Xu2013]
#pragma once

#include <optional>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/diagnoser.hpp"

namespace cordon::estimators {

/// How the statements are computed.
struct OfflineOptions {
  /// What stands for the limit of the sets {x} ⊕ (-X̂_j) in mode i:
  ///   mrpi     the minimal invariant set itself, by its support function
  ///   rpi      a closed-form invariant set, made smaller by iterations; it contains the limit
  ///   iterate  iterations from `start_set`; nears the limit, from outside only if it starts there
  enum class Invariant { mrpi, rpi, iterate };
  Invariant invariant = Invariant::mrpi;
  std::vector<Index> iterations =
      {};                 ///< for rpi and iterate: one for all observers, or one per observer
  Index max_columns = 0;  ///< generators that an iteration reduces to; 0: unlimited
  double accuracy =
      1e-9;  ///< of supports, relative to the support or to the size of the disturbances
  bool separate_inputs = false;  ///< inputs of plant and observer enter as if they were
                                 ///< independent, as published: larger sets
  std::optional<LineForm> start_set = std::nullopt;  ///< of the error x - x̂; iterate
  std::optional<LineForm> error_set = std::nullopt;  ///< X̃, a zonotope; none: a box is computed
  std::optional<LineForm> state_set =
      std::nullopt;  ///< contains the plant's state at all times, whatever the modes
  std::optional<LineForm> initial_set =
      std::nullopt;  ///< of all observers, the plant's x₀ in it; none: X0 of each mode
};

/// A box that contains what every mode's U allows: the intersection of their hulls. All statements
/// rest on u ∈ U; bounds are infinite where U is.
Box input_bounds(const ModeBank& bank);

/// The residual sets R̊_ij of all pairs with the FDI condition, and the check of the error set.
///
/// With C̄_j = mid(g_j) C_j and the like, Ao_j = A_j - L_j C̄_j and e = x - x̂ for any x̂ ∈ X̂_j, in
/// mode i
///   e⁺ = Ao_j e + (A_i - A_j - L_j (C̄_i - C̄_j)) x + (B_i - L_j D̄_i) f_i u - (B_j - L_j D̄_j) f_j u
///   + Bw_i w - Bw_j w̌ - L_j (Dv_i v - Dv_j v̌) - L_j (δ_i - δ_j) r  = C̄_j e + (C̄_i - C̄_j) x + (D̄_i
///   f_i - D̄_j f_j) u + Dv_i v - Dv_j v̌ + δ_i - δ_j
/// with ranges f_i, f_j, checked copies w̌, v̌ of the noises, and what ranges of sensors leave open,
/// |δ| ≤ rad(g) |C x + D f u|. If modes differ in A or C̄ the invariant set is that of (x, e), and
/// the plant has to be stable.
///   holds  i = j: 0 ∈ R̊_ii.  i ≠ j: 0 ∉ R̊_ij, first axis by axis as in [Xu2013, (21)], then by a
///   certified separation. `no` if 0
///          is in a part of the limit. `iterate` says `yes` only where the limit itself agrees, and
///          its boxes hold the limit too: what the iterations alone came to is `iterated`.
/// One `gains[j]` (n×n_y) per mode. Nominal: supports and their tails are bounded with all rounding
/// errors, but from system matrices computed in doubles. Errors: Errc::invalid for an A - L C or a
/// plant that is not Schur, and for whatever `check_offline` reports but an error set that is too
/// small; Errc::unsupported for unbounded sets. O(N² (n_y + n) T n g) for N modes, g generators and
/// T steps to the accuracy.
Guarantees fdi_guarantees(const ModeBank& bank, const std::vector<Matrix>& gains,
                          const OfflineOptions& options);

/// The part of it about the error set: S_ij ⊆ X̃ for the invariant sets S_ij of e, and x - x̂_j ∈ X̃
/// at all times, whatever modes the plant goes through, for the point observers x̂_j that start at
/// the centre of the initial set (or of X0 of mode j) and for every choice of w̌, v̌ and f_j, their
/// centres among them. If modes differ in A or C̄, or sensors have ranges, x is bounded by
/// `state_set`, or, where all modes have the same Schur A, by its own supports from X0 on.
ErrorSetCheck check_error_set(const ModeBank& bank, const std::vector<Matrix>& gains,
                              const OfflineOptions& options);

/// Per observer, a box that holds the residuals of the same point observers at all times, whatever
/// modes the plant goes through.
std::vector<Box> residual_bounds(const ModeBank& bank, const std::vector<Matrix>& gains,
                                 const OfflineOptions& options);

/// Problems of the options and the models, with pointers relative to the diagnoser's object; an
/// error set that is too small among them. Empty: `fdi_guarantees` will succeed.
std::vector<Diagnostic> check_offline(const ModeBank& bank, const std::vector<Matrix>& gains,
                                      const OfflineOptions& options);

}  // namespace cordon::estimators
