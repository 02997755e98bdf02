// SPDX-License-Identifier: GPL-3.0-or-later
// States that linear models carry on, rounding enclosed.
#pragma once

#include "cordon/interfaces/model.hpp"

namespace cordon {

/// x ∈ c + G [-1, 1]^g. What is rounded has generators of its own.
class CarriedZonotope {
 public:
  /// The set if it is a zonotope, else its interval hull. Errc::unsupported unless bounded.
  CarriedZonotope(const LineForm& X, const char* name);
  /// {A x + B u + Bw w : w ∈ W}
  void advance(const LinearModel& m, VectorIn u, const CarriedZonotope& W);
  Box hull() const;

 private:
  Vector c_;
  Matrix G_;
};

}  // namespace cordon
