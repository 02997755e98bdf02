// SPDX-License-Identifier: GPL-3.0-or-later
// What the errors of all steps so far add up to in a stable recursion.
#pragma once

#include <memory>

#include "cordon/core/types.hpp"
#include "cordon/interfaces/archive.hpp"

namespace cordon::estimators {

/// Bounds |e_k| of e⁺ = F e + δ, e₀ = 0, for |δ_j| ≤ s_j that become known step by step. With the
/// least m, a power of two, of which ‖Fᵐ‖∞ ≤ 1/2, time is cut into blocks of m steps:
///   |e| ≤ max_{i<m} |Fⁱ| p + (Σ_{i<m} |Fⁱ|) max s of this block,
/// where p bounds |e| at the block's beginning. What is long past is forgotten as F decays, however
/// large |F| is. Where no m up to 4096 is found bounds hold as well, and may grow. O(n) per step,
/// O(n²) per block and for a bound, O(n³ m) once; beyond 1e9 operations blocks are doubled by
/// |Fᵐ⁺ⁱ| ≤ |Fᵐ| |Fⁱ|, in O(n³ log m). Copies share what does not change.
class ErrorMemory {
 public:
  explicit ErrorMemory(const Matrix& F);

  void start();
  void step(VectorIn sizes);
  Vector bound() const;
  /// Without memory of its own.
  void add_bound(Vector& to) const;
  /// At least Σ_j ‖Fʲ‖∞ over all j, with room for the rounding of the powers; ∞: not known.
  double sum_of_norms() const { return of_->sum_of_norms; }
  void serialize(Archive& archive);

 private:
  struct Powers {
    explicit Powers(const Matrix& F);

    Matrix power, largest, sum;  ///< |Fᵐ|, max |Fⁱ|, Σ |Fⁱ|
    Index block = 0;
    double sum_of_norms = infinity;
  };

  std::shared_ptr<const Powers> of_;
  Index steps_ = 0;
  Vector past_, now_;  ///< p, max s
};

}  // namespace cordon::estimators
