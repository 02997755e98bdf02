// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/types.hpp"

namespace cordon {

/// A plant that is not the study's linear model, as a source of simulated data: x⁺ = next(k, x, u),
/// y = output(k, x, u), in the coordinates of the model (deviations from an operating point, if the
/// model has one). The simulation applies the effectiveness of a fault to u before and to y after,
/// and adds the measurement noise Dv v; it draws no disturbance w: what the linear model misses of
/// the plant is what its W has to bound.
///
/// Immutable; used from several threads. Results that are not finite end the simulation with an
/// error.
class Plant {
 public:
  virtual ~Plant() = default;
  Index states() const { return do_states(); }
  Index inputs() const { return do_inputs(); }
  Index outputs() const { return do_outputs(); }
  /// Both throw Errc::dimension for an x or u of another size, Errc::violated for a result of
  /// another size.
  Vector next(Index k, VectorIn x, VectorIn u) const;
  Vector output(Index k, VectorIn x, VectorIn u) const;

 private:
  virtual Index do_states() const = 0;
  virtual Index do_inputs() const = 0;
  virtual Index do_outputs() const = 0;
  virtual Vector do_next(Index k, VectorIn x, VectorIn u) const = 0;
  virtual Vector do_output(Index k, VectorIn x, VectorIn u) const = 0;
};

}  // namespace cordon
