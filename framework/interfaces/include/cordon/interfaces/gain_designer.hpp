// SPDX-License-Identifier: GPL-3.0-or-later
// The gain designer: finds the output gain L of an observer x̂⁺ = A x̂ + … + L (y - ŷ).
#pragma once

#include <limits>
#include <string>

#include "cordon/core/answer.hpp"
#include "cordon/interfaces/model.hpp"

namespace cordon {

/// What was found out about a gain after it was designed, by other means than those that found it.
/// C̄ = mid(g) C.
struct GainCertificate {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  /// A bound of that of A - L C̄ from above, proven, and equal to it where A - L C̄ is not far from
  /// normal
  double spectral_radius = none;
  /// A - L C̄ ≥ 0 in every entry, without rounding; `unknown`: not so, but no entry is below zero by
  /// more than its rounding
  Answer monotone = Answer::unknown;
  /// Bounds of ‖G_ed‖∞, G_ed(z) = (zI - (A - L C̄))⁻¹ [Eθ, Bw G_W, -L Dv G_V], with the shapes G of
  /// zonotopes around W and V; Eθ holds the directions of the parameter uncertainty in the design.
  /// Infinite if A - L C̄ is not stable.
  double norm_lower = none, norm_upper = none;
  std::string objective =
      {};  ///< what was optimised, for people: "γ", "τ", "sum of half widths"; empty: nothing was
  double optimum = none;        ///< its optimal value, as the solver found it
  double optimum_bound = none;  ///< a bound of the optimum from the dual side, in doubles
  double margin = none;         ///< smallest eigenvalue of the matrix inequality at the solution,
                                ///< recomputed; negative: violated by that
};

struct Gain {
  std::string name = "gain";  ///< the observer's parameter: "gain", "upper_gain", …
  std::string type = {};      ///< the designer's component name
  Matrix L;                   ///< n×n_y
  GainCertificate certificate = {};
};

/// A gain, or why there is none.
struct GainDesign {
  Answer feasible = Answer::unknown;  ///< `no`: it is proven that no gain meets the conditions;
                                      ///< `unknown`: none was found
  Gain gain = {};                     ///< if `feasible` is yes
  std::string reason = {};            ///< else
  std::string suggestion = {};        ///< may be empty
};

/// Immutable; used from several threads. Models with E are refused by the registry's callers before
/// a designer sees them.
class GainDesigner {
 public:
  virtual ~GainDesigner() = default;
  GainDesigner(const GainDesigner&) = delete;
  GainDesigner& operator=(const GainDesigner&) = delete;

  /// The gain for all times, or for the steady state. Never a gain that leaves A - L C̄ unstable.
  /// Who asks looks at L before it uses it (`gain_problem` in estimators/gains).
  GainDesign design(const Model& model) const { return do_design(model); }

  /// Does the gain follow the set of states?
  bool is_time_varying() const { return do_is_time_varying(); }
  /// The gain of this step for a set of states with covariation P = R Rᵀ (R the generators of a
  /// zonotope around it), n×n. Called if `is_time_varying`; O(n³). Throws Errc::dimension for
  /// another P, Errc::violated if L is not n×n_y or not finite.
  Matrix update(const Model& model, MatrixIn P) const;

 protected:
  GainDesigner() = default;

 private:
  virtual GainDesign do_design(const Model& model) const = 0;
  virtual bool do_is_time_varying() const { return false; }
  virtual Matrix do_update(const Model& model, MatrixIn P) const;
};

}  // namespace cordon
