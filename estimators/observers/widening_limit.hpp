// SPDX-License-Identifier: GPL-3.0-or-later
// A limit, known in advance, to what reductions add to the sets of a Luenberger recursion.
#pragma once

#include <optional>

#include "cordon/core/box.hpp"
#include "cordon/interfaces/archive.hpp"
#include "cordon/interfaces/backend.hpp"
#include "observers/luenberger_recursion.hpp"

namespace cordon::estimators {

/// Half widths of the interval hull of the errors e⁺ = F e ⊕ N [-1,1]^m ⊕ box(bₖ), |e₀| ≤ h₀, as if
/// nothing were ever reduced:
///   hₖ = |Fᵏ| h₀ + Σ_{j<k} |Fʲ N| 1 + (Σ_{j<k} |Fʲ|) max_{i<k} bᵢ,
/// exact but for b, which may differ from step to step. Bounded for stable F, whatever |F| is. Once
/// what all later powers add is a negligible share of the sums, this is added and they are left as
/// they are. O(n² (n + m)) per step until then. [Kofman2007]
class ErrorHull {
 public:
  /// F is n×n, N n×m, h₀ ≥ 0.
  ErrorHull(Matrix F, Matrix N, Vector start);

  /// From k to k + 1; b ≥ 0, of size 0: none. A b that is not finite makes the half widths
  /// infinite.
  void step(const Vector& b);
  Vector half_widths() const;
  void serialize(Archive& archive);

 private:
  void settle();

  Matrix F_, power_, N_, noise_;  ///< F, Fᵏ, N, Fᵏ N
  Matrix powers_;                 ///< Σ_{j<k} |Fʲ|
  Vector start_, sum_, b_;        ///< h₀, Σ_{j<k} |Fʲ N| 1, max b
  Index steps_ = 0;
  bool settled_ = false;
};

/// Replaces a reduced set by the box around the unreduced one, where it has become wider in a
/// coordinate than `limit` times that box: estimates of a stable error then stay below `limit`
/// times what they were without reductions, for every backend, reduction and budget. The box is
/// around the centre of the recursion; that it holds the unreduced set is Σ above, in the
/// arithmetic of the caller: for backends with outward rounding nothing is replaced. Sets with
/// constraints or lines, whose hulls take programs, and gains that vary in time are left alone.
class WideningLimit {
 public:
  /// `limit` ≥ 1, or 0: none.
  explicit WideningLimit(double limit) : limit_(limit) {}
  bool is_set() const { return limit_ != 0; }

  /// X is the set that the recursion starts from.
  void start(const LuenbergerRecursion& recursion, const Enclosure& X);
  /// The recursion has taken the sample; `open`: the half widths that it added for ranges and
  /// interval matrices.
  void step(const LuenbergerRecursion& recursion, const Sample& before, const Vector& open);
  /// The same of a step by another recursion, that of the outputs which the sample had: hₖ is begun
  /// anew, with the box around its errors.
  void step_with_gap(const LuenbergerRecursion& recursion, const LuenbergerRecursion& others,
                     const Sample& before, const Vector& open);
  void stop() { errors_.reset(); }
  void serialize(Archive& archive, const LuenbergerRecursion& recursion);

  /// X, reduced, or the box in its place. `hull`, if asked for: that of the result; of dimension 0
  /// where it was not needed.
  Enclosure apply(const SetBackend& backend, const Enclosure& X, Box* hull = nullptr) const;

 private:
  Vector rounding_of(const LuenbergerRecursion& recursion, const Sample& before) const;

  double limit_;
  std::optional<ErrorHull> errors_;
  Vector center_;
};

}  // namespace cordon::estimators
