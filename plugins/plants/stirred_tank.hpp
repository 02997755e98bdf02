// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "cordon/interfaces/plant_formulas.hpp"

namespace cordon::plants {

/// Table 1 of [Xu2014]. Volumes in litres, times in minutes, amounts in moles, temperatures in
/// kelvin, masses in grams, heat in calories.
struct StirredTankParameters {
  double volume = 100, feed_flow = 100, feed_concentration = 1, feed_temperature = 350;
  double coolant_flow = 100, coolant_temperature = 350;
  double density = 1000, coolant_density = 1000, specific_heat = 1, coolant_specific_heat = 1;
  double rate_factor = 7.2e10;             ///< k₀, per minute
  double activation_temperature = 9.98e3;  ///< E/R
  double reaction_heat = 2e5;              ///< -ΔH per mole: positive for an exothermic reaction
  double heat_transfer = 7e5;              ///< hA, calories per minute and kelvin
  double concentration = 0.08235,
         temperature = 441.81;  ///< where the search for the operating point begins
  double sampling = 0.1;        ///< time of one step, in minutes
  std::int64_t substeps = 250;  ///< steps of the integration in one step of time
};

/// A continuously stirred tank with an irreversible exothermic reaction A → B, cooled through its
/// wall; x⁺ is the solution after one sampling time, with a constant coolant flow.
///     ċ = q/V (c_f - c) - r,                      r = k₀ c exp(-E/(R T))
///     Ṫ = q/V (T_f - T) + (-ΔH)/(ρ C_p) r + ρ_c C_pc/(ρ C_p V) q_c (1 - exp(-hA/(q_c ρ_c C_pc)))
///     (T_c - T)
/// Sizes: two states, concentration and temperature; one input, the coolant flow q_c; one output,
/// the concentration. All are deviations from the operating point: the equilibrium under the given
/// coolant flow that Newton's method finds from the given concentration and temperature. (The
/// published point is rounded to four digits. Beginning there, the state drifts by 0.002 K in the
/// first step; in deviations from the equilibrium, x = 0 with u = 0 stays where it is.) Degenerate:
/// q_c = 0 is a tank without cooling, the limit of the formula. A negative flow gives NaN, which
/// ends a simulation. Accuracy: classical Runge-Kutta method of fourth order with `substeps` steps.
/// Near the operating point twice as many steps change x⁺ by less than 10⁻⁹. As formulas: the same
/// steps, for q_c > 0 only, and not defined for sets of temperatures with 0 K in them. Errors:
/// Errc::invalid if no equilibrium is found, if the substeps are too long to stay in it, and for
/// formulas of more than `most_formula_substeps` substeps. Cost: 8 exponentials per substep.
/// Source: [Xu2014, section 6].
class StirredTank final : public Plant {
 public:
  explicit StirredTank(const StirredTankParameters& parameters);

 private:
  Index do_states() const override { return 2; }
  Index do_inputs() const override { return 1; }
  Index do_outputs() const override { return 1; }
  Vector do_next(Index k, VectorIn x, VectorIn u) const override;
  Vector do_output(Index k, VectorIn x, VectorIn u) const override;
  std::optional<PlantFormulas> do_formulas(const PlantVariables& of) const override;

  /// Of numbers, or of formulas.
  template <class Number>
  struct State {
    Number concentration, temperature;
  };
  /// Derivatives at a state; `cooling` is the factor of T_c - T, per minute.
  template <class Number>
  State<Number> rates(const State<Number>& at, const Number& cooling) const;
  template <class Number>
  State<Number> after_step(const State<Number>& at, const Number& cooling) const;
  double cooling(double coolant_flow) const;
  formulas::Expression cooling(formulas::Expression coolant_flow) const;
  void find_equilibrium();

  StirredTankParameters of_;
  State<double> equilibrium_;
};

}  // namespace cordon::plants
