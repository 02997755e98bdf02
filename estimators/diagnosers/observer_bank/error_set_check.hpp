// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of the errors of all observers, and whether a set holds them.
#pragma once

#include <string>
#include <vector>

#include "diagnosers/observer_bank/fdi_conditions.hpp"
#include "diagnosers/observer_bank/state_bounds.hpp"

namespace cordon::estimators {

/// Half widths of the boxes of sensor ranges in the steady state of a pair; empty entries for
/// sensors that are known exactly.
SensorSlack steady_slack(const ModeDynamics& plant, const ModeDynamics& observer,
                         const OfflineOptions& options);

/// The pair's system in its steady state.
PairDynamics steady_pair(const ModeDynamics& plant, const ModeDynamics& observer,
                         const OfflineOptions& options);

/// Sizes of all disturbances, for a decay bound.
Vector drive_size(const std::vector<sets::Zonotope>& drives, Index n);

/// Bounds of the errors of all observers, whatever modes the plant goes through, and of the
/// invariant sets of each pair. Observers start at the centre of their initial set.
class ErrorBounds {
 public:
  /// Throws Errc::invalid if modes differ in how the state acts on errors and nothing bounds the
  /// state, Errc::unsupported for unbounded initial sets.
  ErrorBounds(const ModeBank& bank, const std::vector<ModeDynamics>& modes,
              const OfflineOptions& options);

  /// Along the rows of a matrix (plus) and against them (minus): of all errors, and of each S_ij (a
  /// matrix per row, entry (i, j)).
  struct Supports {
    Vector plus, minus;
    std::vector<Matrix> steady_plus, steady_minus;
  };
  Supports along(const Matrix& directions) const;
  /// Holds the residuals of observer j at all times.
  Box residuals(Index j) const;

 private:
  const std::vector<ModeDynamics>& modes_;
  OfflineOptions options_;
  std::vector<invariant::Decay> decays_;  // of Ao
  std::vector<std::vector<sets::Zonotope>> drives_, starts_,
      direct_;  // per observer: of the error in each mode, and at the start; what enters residuals
};

/// How far the errors exceed `set` about its centre, by bounds along its facets: upper bounds,
/// infinite where the set is flat. The facets of a zonotope with many generators in many dimensions
/// are replaced by those of a parallelotope inside. Throws Errc::invalid for a set that is no
/// zonotope.
ErrorSetCheck compare_error_set(const ErrorBounds& bounds, const LineForm& set);

/// A box around all errors in n dimensions, the smallest but for a share of 1e-9.
ErrorSetCheck compute_error_set(const ErrorBounds& bounds, Index n);

/// What is wrong with the error set that the options give: no zonotope, or too small. Throws as
/// ErrorBounds does.
void check_given_error_set(const ModeBank& bank, const std::vector<ModeDynamics>& modes,
                           const OfflineOptions& options, std::vector<Diagnostic>& problems);

/// As messages name it.
std::string four_digits(double x);

}  // namespace cordon::estimators
