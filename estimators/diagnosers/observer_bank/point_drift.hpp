// SPDX-License-Identifier: GPL-3.0-or-later
// How far a point observer that lacks outputs strays from one that has them all.
#pragma once

#include <optional>

#include "cordon/core/box.hpp"
#include "cordon/interfaces/archive.hpp"
#include "cordon/interfaces/model.hpp"
#include "cordon/sets/zonotope.hpp"

namespace cordon::estimators {

/// With x̂ the point observer of the outputs that are there, and x̂' that of all outputs, of which
/// the missing ones are known to somebody else: δ = x̂ - x̂' is 0 until a first gap, and then
///   δ⁺ = (A - L_P C_P) δ - L_M r_M + ρ,   r_M ∈ R_M,
/// with what the step rounds, ρ, and with the columns L_P of outputs that are there, L_M of those
/// that are missing, and a box R that holds the residuals of x̂' at all times. What bounds x - x̂'
/// bounds x - x̂ = (x - x̂') - δ.
class PointDrift {
 public:
  bool is_none() const { return !set_; }
  void start() { set_.reset(); }
  /// From the sample's time to the next: `error_map` is A - L_P C_P, of the outputs that it has.
  /// Bounds of |ρ|, and of |x̂ - x̂'| before a first gap, by rounding alone. O(n² g), g ≤ 20 n.
  void step(const Sample& sample, MatrixIn error_map, MatrixIn L, const Box& residuals,
            VectorIn rounding, VectorIn before_gap);
  /// In n dimensions.
  void serialize(Archive& archive, Index n);
  /// Holds δ.
  const sets::Zonotope& set() const { return *set_; }

 private:
  std::optional<sets::Zonotope> set_;  ///< none: {0}
};

}  // namespace cordon::estimators
