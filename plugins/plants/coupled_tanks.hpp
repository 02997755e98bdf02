// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>

#include "cordon/interfaces/plant_formulas.hpp"

namespace cordon::plants {

/// Lengths in centimetres, times in seconds. The outlets are such that at 1.5 V a step of one
/// second has the published linear model: a level decays by 0.0114 (upper) and 0.0097 (lower) per
/// second.
struct CoupledTanksParameters {
  double gravity = 981;
  double upper_inflow = 0.2261;  ///< (1 - γ₂) K_p / A₂, per volt
  double lower_inflow = 0;       ///< γ₁ K_p / A₁, per volt
  double upper_outlet = 0.0114 * std::sqrt(0.2261 * 1.5 / 0.0114 / 981);  ///< a₂ / A₂
  double lower_outlet = 0.0097 * std::sqrt(0.2261 * 1.5 / 0.0097 / 981);  ///< a₁ / A₁
  double section_ratio = 1;                                               ///< A₂ / A₁
  double voltage = 1.5;  ///< of the pump at the operating point
  double highest_voltage = 5;
  double height = 25;  ///< of both tanks
  double sampling = 1;
  std::int64_t substeps = 1;  ///< Euler steps in one step of time
};

/// Two tanks, one above the other: a pump fills the upper one, which drains into the lower one,
/// which drains into the basin.
///     ḣ₂ = -a₂/A₂ √(2 g h₂) + (1 - γ₂) K_p/A₂ u
///     ḣ₁ = -a₁/A₁ √(2 g h₁) + a₂/A₁ √(2 g h₂) + γ₁ K_p/A₁ u
/// Sizes: two states, the levels of the upper tank (h₂, first) and the lower one (h₁); one input,
/// the voltage u of the pump; one output, the level of the lower tank. All are deviations from the
/// operating point: the equilibrium under the given voltage. Degenerate: an empty tank stays empty,
/// a full one overflows and stays full. A voltage outside [0, highest_voltage] gives NaN, which
/// ends a simulation. Accuracy: Euler's method with `substeps` steps: with one, the discrete-time
/// plant that the linear model belongs to. As formulas: the same steps, levels held between empty
/// and full by min and max; not defined for a voltage outside. Errors: Errc::invalid for an
/// operating point outside the tanks or the range of the pump, and for formulas of more than
/// `most_formula_substeps` substeps. Cost: two square roots per substep. Source: [Pourasghar2021,
/// (71)], whose printed model (72) numbers the tanks the other way round.
class CoupledTanks final : public Plant {
 public:
  explicit CoupledTanks(const CoupledTanksParameters& parameters);

 private:
  Index do_states() const override { return 2; }
  Index do_inputs() const override { return 1; }
  Index do_outputs() const override { return 1; }
  Vector do_next(Index k, VectorIn x, VectorIn u) const override;
  Vector do_output(Index k, VectorIn x, VectorIn u) const override;
  std::optional<PlantFormulas> do_formulas(const PlantVariables& of) const override;

  /// Of numbers, or of formulas.
  template <class Number>
  struct Levels {
    Number upper, lower;
  };
  template <class Number>
  Levels<Number> inside(const Number& upper, const Number& lower) const;
  template <class Number>
  Levels<Number> after_step(const Levels<Number>& at, const Number& voltage) const;

  CoupledTanksParameters of_;
  double upper_ = 0, lower_ = 0;  ///< levels at the operating point
};

}  // namespace cordon::plants
