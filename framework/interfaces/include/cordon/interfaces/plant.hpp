// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "cordon/core/types.hpp"

namespace cordon {

struct PlantFormulas;  // plant_formulas.hpp
struct PlantVariables;

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

  /// `next` and `output` as formulas, with which a study can take the plant for its system;
  /// nothing: it has none. Where both are defined, they agree up to rounding errors. Guarantees
  /// speak of the formulas, in real arithmetic, with their constants as they are. Throws
  /// Errc::dimension for other numbers of variables; Errc::violated for other numbers of formulas,
  /// and for those of another graph; Errc::invalid where they have too many parts
  /// (`formulas::Graph::most_nodes`).
  std::optional<PlantFormulas> as_formulas(const PlantVariables& of) const;

 private:
  virtual Index do_states() const = 0;
  virtual Index do_inputs() const = 0;
  virtual Index do_outputs() const = 0;
  virtual Vector do_next(Index k, VectorIn x, VectorIn u) const = 0;
  virtual Vector do_output(Index k, VectorIn x, VectorIn u) const = 0;
  virtual std::optional<PlantFormulas> do_formulas(const PlantVariables& of) const;  // none
};

}  // namespace cordon
