// SPDX-License-Identifier: GPL-3.0-or-later
#include "stirred_tank.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "cordon/core/error.hpp"
#include "formula_parts.hpp"

namespace cordon::plants {

namespace {
constexpr int newton_steps = 100;
constexpr double newton_tolerance =
    1e-12;  // of a step, relative to the state: far above its rounding errors
constexpr double drift_tolerance =
    1e-6;  // at rest, relative to the state: above what rounding errors can grow to in one step
}  // namespace

StirredTank::StirredTank(const StirredTankParameters& parameters)
    : of_(parameters), equilibrium_{parameters.concentration, parameters.temperature} {
  find_equilibrium();
  const Vector drift = next(0, Vector::Zero(2), Vector::Zero(1));
  if (!(std::abs(drift[0]) <= drift_tolerance * std::abs(equilibrium_.concentration) &&
        std::abs(drift[1]) <= drift_tolerance * equilibrium_.temperature)) {
    throw Error(Errc::invalid,
                "the integration leaves the equilibrium: the reaction is too fast for this step, "
                "give more substeps");
  }
}

double StirredTank::cooling(double coolant_flow) const {
  if (coolant_flow < 0) return std::numeric_limits<double>::quiet_NaN();
  if (coolant_flow == 0) return 0;
  const double capacity = coolant_flow * of_.coolant_density * of_.coolant_specific_heat;
  return -capacity * std::expm1(-of_.heat_transfer / capacity) /
         (of_.density * of_.specific_heat * of_.volume);
}

formulas::Expression StirredTank::cooling(formulas::Expression coolant_flow) const {
  const double of_flow = of_.coolant_density * of_.coolant_specific_heat;
  // 1/q by the root, which is not defined below 0.
  const auto transferred = exp(-of_.heat_transfer / of_flow * power(sqrt(coolant_flow), -2));
  return of_flow / (of_.density * of_.specific_heat * of_.volume) * coolant_flow *
         (1 - transferred);
}

template <class Number>
StirredTank::State<Number> StirredTank::rates(const State<Number>& at,
                                              const Number& cooling) const {
  using std::exp;
  const double exchange = of_.feed_flow / of_.volume;
  const Number reaction =
      of_.rate_factor * at.concentration * exp(-of_.activation_temperature / at.temperature);
  return {exchange * (of_.feed_concentration - at.concentration) - reaction,
          exchange * (of_.feed_temperature - at.temperature) +
              of_.reaction_heat / (of_.density * of_.specific_heat) * reaction +
              cooling * (of_.coolant_temperature - at.temperature)};
}

template <class Number>
StirredTank::State<Number> StirredTank::after_step(const State<Number>& at,
                                                   const Number& cooling) const {
  const double h = of_.sampling / static_cast<double>(of_.substeps);
  const auto ahead = [&](const State<Number>& rate, double by) {
    return State<Number>{at.concentration + by * rate.concentration,
                         at.temperature + by * rate.temperature};
  };
  const State<Number> k1 = rates<Number>(at, cooling),
                      k2 = rates<Number>(ahead(k1, h / 2), cooling),
                      k3 = rates<Number>(ahead(k2, h / 2), cooling),
                      k4 = rates<Number>(ahead(k3, h), cooling);
  return {at.concentration + h / 6 *
                                 (k1.concentration + 2 * k2.concentration + 2 * k3.concentration +
                                  k4.concentration),
          at.temperature +
              h / 6 * (k1.temperature + 2 * k2.temperature + 2 * k3.temperature + k4.temperature)};
}

void StirredTank::find_equilibrium() {
  const double exchange = of_.feed_flow / of_.volume,
               heating = of_.reaction_heat / (of_.density * of_.specific_heat);
  const double lost = cooling(of_.coolant_flow);
  State<double>& at = equilibrium_;
  for (int step = 0; step < newton_steps; ++step) {
    const State<double> rate = rates<double>(at, lost);
    const double speed = of_.rate_factor * std::exp(-of_.activation_temperature / at.temperature);
    const double slope =
        speed * at.concentration * of_.activation_temperature / (at.temperature * at.temperature);
    const double cc = -exchange - speed, ct = -slope, tc = heating * speed,
                 tt = -exchange + heating * slope - lost;
    const double determinant = cc * tt - ct * tc;
    const State<double> change{(ct * rate.temperature - tt * rate.concentration) / determinant,
                               (tc * rate.concentration - cc * rate.temperature) / determinant};
    at.concentration += change.concentration;
    at.temperature += change.temperature;
    if (!std::isfinite(at.concentration) || !std::isfinite(at.temperature) || at.temperature <= 0)
      break;
    if (std::abs(change.concentration) <= newton_tolerance * std::abs(at.concentration) &&
        std::abs(change.temperature) <= newton_tolerance * at.temperature) {
      return;
    }
  }
  throw Error(Errc::invalid, "no equilibrium was found from concentration " +
                                 std::to_string(of_.concentration) + " and temperature " +
                                 std::to_string(of_.temperature) +
                                 ": give values nearer to one, or another coolant_flow");
}

Vector StirredTank::do_next(Index, VectorIn x, VectorIn u) const {
  const double lost = cooling(of_.coolant_flow + u[0]);
  State<double> at{equilibrium_.concentration + x[0], equilibrium_.temperature + x[1]};
  for (std::int64_t i = 0; i < of_.substeps; ++i) {
    at = after_step<double>(at, lost);
    // Arrhenius' law means nothing there, and would give a finite number again.
    if (at.temperature <= 0) return Vector::Constant(2, std::numeric_limits<double>::quiet_NaN());
  }
  return Vector{
      {at.concentration - equilibrium_.concentration, at.temperature - equilibrium_.temperature}};
}

std::optional<PlantFormulas> StirredTank::do_formulas(const PlantVariables& of) const {
  using formulas::Expression;
  require_formula_substeps(of_.substeps);
  const Expression lost = cooling(of_.coolant_flow + of.u[0]);
  State<Expression> at{equilibrium_.concentration + of.x[0], equilibrium_.temperature + of.x[1]};
  for (std::int64_t i = 0; i < of_.substeps; ++i) at = after_step<Expression>(at, lost);
  return PlantFormulas{
      {at.concentration - equilibrium_.concentration, at.temperature - equilibrium_.temperature},
      {of.x[0]}};
}

Vector StirredTank::do_output(Index, VectorIn x, VectorIn) const { return x.head(1); }

}  // namespace cordon::plants
