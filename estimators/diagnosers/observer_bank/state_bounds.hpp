// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of the plant's state, and of what ranges of sensors make of it.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "cordon/invariant/minimal.hpp"
#include "diagnosers/observer_bank/error_dynamics.hpp"
#include "diagnosers/observer_bank/fdi_conditions.hpp"

namespace cordon::estimators {

/// The sets that the plant may start in, whichever mode it starts in; without repetitions. Throws
/// Errc::unsupported for unbounded sets.
std::vector<sets::Zonotope> plant_starts(const ModeBank& bank, const OfflineOptions& options);

/// Bounds of the plant's state at all times, whatever modes it goes through.
class StateBounds {
 public:
  /// From options.state_set; else, if all modes have the same Schur A, from `plant_starts` and the
  /// disturbances of all modes. If neither, nothing is known.
  StateBounds(const ModeBank& bank, const std::vector<ModeDynamics>& modes,
              const OfflineOptions& options);

  bool is_known() const { return set_ || decay_; }
  /// Contains T x: the image of the given set, or a box by supports along the rows of T. Throws
  /// Errc::invalid if nothing is known.
  sets::Zonotope image(const Matrix& T) const;
  /// Bounds of |T x|.
  Vector magnitude(const Matrix& T) const;

 private:
  Interval along(VectorIn row) const;

  std::optional<sets::Zonotope> set_;
  std::optional<invariant::Decay> decay_;
  std::vector<sets::Zonotope> drives_, starts_;
  double accuracy_;
  std::vector<std::pair<Vector, Interval>>
      computed_;  // along the axes, and along the rows of the first mode's C
};

/// Half widths s of the box that holds δ_j of an observer with ranges of sensors, rad(g) |C x̂ + D f
/// u| ≤ s for x̂ = x - e: the least s = rad(g) (|D f u| + max |C x| + max |C e|), where δ_j adds to
/// the bound `error` of |C e| the terms K s, K_ab = Σ_k |c_a Aoᵏ l_b|. Throws Errc::invalid if
/// ρ(diag(rad g) K) ≥ 1: the range is too wide for a bounded error.
Vector observer_slack(const ModeDynamics& observer, const invariant::Decay& decay,
                      const Vector& state, const Vector& error, double accuracy);

}  // namespace cordon::estimators
