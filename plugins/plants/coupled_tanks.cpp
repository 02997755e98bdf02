// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupled_tanks.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "cordon/core/error.hpp"
#include "formula_parts.hpp"

namespace cordon::plants {

CoupledTanks::CoupledTanks(const CoupledTanksParameters& parameters) : of_(parameters) {
  if (of_.voltage > of_.highest_voltage) {
    throw Error(Errc::invalid, "the voltage at the operating point, " +
                                   std::to_string(of_.voltage) + " V, is above the highest, " +
                                   std::to_string(of_.highest_voltage) + " V");
  }
  const double through = of_.upper_inflow * of_.voltage;  // per area of the upper tank
  const auto level = [&](double flow, double outlet) {
    return flow / outlet * (flow / outlet) / (2 * of_.gravity);
  };
  upper_ = level(through, of_.upper_outlet);
  lower_ = level(of_.section_ratio * through + of_.lower_inflow * of_.voltage, of_.lower_outlet);
  if (upper_ <= of_.height && lower_ <= of_.height) return;
  throw Error(Errc::invalid, "the equilibrium under " + std::to_string(of_.voltage) +
                                 " V has levels of " + std::to_string(upper_) + " cm and " +
                                 std::to_string(lower_) + " cm, above the height of the tanks, " +
                                 std::to_string(of_.height) + " cm: give a lower voltage");
}

template <class Number>
CoupledTanks::Levels<Number> CoupledTanks::inside(const Number& upper, const Number& lower) const {
  using std::max, std::min;
  return {min(max(upper, 0.0), of_.height), min(max(lower, 0.0), of_.height)};
}

template <class Number>
CoupledTanks::Levels<Number> CoupledTanks::after_step(const Levels<Number>& at,
                                                      const Number& voltage) const {
  using std::sqrt;
  const double step = of_.sampling / static_cast<double>(of_.substeps);
  const Number drained = of_.upper_outlet * sqrt(2 * of_.gravity * at.upper);
  const Number left = of_.lower_outlet * sqrt(2 * of_.gravity * at.lower);
  return inside<Number>(
      at.upper + step * (of_.upper_inflow * voltage - drained),
      at.lower + step * (of_.section_ratio * drained - left + of_.lower_inflow * voltage));
}

Vector CoupledTanks::do_next(Index, VectorIn x, VectorIn u) const {
  const double voltage = of_.voltage + u[0];
  if (!(voltage >= 0 && voltage <= of_.highest_voltage))
    return Vector::Constant(2, std::numeric_limits<double>::quiet_NaN());
  Levels<double> at = inside<double>(upper_ + x[0], lower_ + x[1]);
  for (std::int64_t i = 0; i < of_.substeps; ++i) at = after_step<double>(at, voltage);
  return Vector{{at.upper - upper_, at.lower - lower_}};
}

std::optional<PlantFormulas> CoupledTanks::do_formulas(const PlantVariables& of) const {
  using formulas::Expression;
  require_formula_substeps(of_.substeps);
  const Expression given = of_.voltage + of.u[0];
  // Twice the same, not defined below 0 and not defined above the highest.
  const Expression rising = at_least_zero(given),
                   falling = of_.highest_voltage - at_least_zero(of_.highest_voltage - given);
  const Expression voltage = 0.5 * (rising + falling);
  Levels<Expression> at = inside<Expression>(upper_ + of.x[0], lower_ + of.x[1]);
  for (std::int64_t i = 0; i < of_.substeps; ++i) at = after_step<Expression>(at, voltage);
  return PlantFormulas{{at.upper - upper_, at.lower - lower_}, {of.x[1]}};
}

Vector CoupledTanks::do_output(Index, VectorIn x, VectorIn) const { return x.tail(1); }

}  // namespace cordon::plants
